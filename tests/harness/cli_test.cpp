// The command line as a user meets it: what is refused, in which words, and that nothing is left behind.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include "harness/base/names.h"
#include "harness/experiment/algorithms.h"
#include "harness/experiment/chosen_kernel.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/option_values.h"
#include "harness/experiment/options.h"
#include "harness/experiment/step_record.h"
#include "harness/world/ode_baselines.h"
#include "partition/registry.h"
#include "scenarios/scene.h"
#include "solver/registry.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

struct BadInput {
  std::vector<std::string> arguments;  // after "run --scene rock_pile --out DIR"
  std::vector<std::string> pieces;     // all of them must stand in the one line
};

const std::vector<BadInput> kBadInputs = {
    {{"--mu", "-1"}, {"--mu", "-1", "[0, inf)"}},
    {{"--mu=-1"}, {"--mu", "-1", "[0, inf)"}},
    {{"--mu", "x"}, {"--mu", "'x'", "number", "[0, inf)"}},
    {{"--mu", "1x"}, {"--mu", "'1x'", "number"}},
    {{"--mu", "inf"}, {"--mu", "inf", "[0, inf)"}},
    {{"--dt", "0"}, {"--dt", "0", "(0, inf)"}},
    {{"--dt", "-0.1"}, {"--dt", "-0.1", "(0, inf)"}},
    {{"--dt", "nan"}, {"--dt", "nan", "(0, inf)"}},
    {{"--dt", "1e999"}, {"--dt", "1e999", "(0, inf)"}},
    {{"--cfm", "-1e-5"}, {"--cfm", "-1e-5", "[0, inf)"}},
    {{"--erp", "1.5"}, {"--erp", "1.5", "[0, 1]"}},
    {{"--gravity", "nan"}, {"--gravity", "nan", "[-1e+06, 1e+06]"}},
    {{"--gravity", "1e160"}, {"--gravity", "1e160", "[-1e+06, 1e+06]"}},
    {{"--contact-cap", "0"}, {"--contact-cap", "0", "[1, 65535]"}},
    {{"--match-tolerance", "-1"}, {"--match-tolerance", "-1", "[0, inf)"}},
    {{"--max-bodies", "0"}, {"--max-bodies", "0", "[1, inf)"}},
    {{"--max-bodies", "2.5"}, {"--max-bodies", "'2.5'", "whole number", "[1, inf)"}},
    {{"--max-bodies", "99999999999"}, {"--max-bodies", "99999999999", "[1, 2147483647]"}},
    {{"--tau-mr", "1"}, {"--tau-mr", "1", "(1, inf)"}},
    {{"--tau-mix", "1.1"}, {"--tau-mix", "1.1", "[0, 1]"}},
    {{"--tau-mix", "-0.1"}, {"--tau-mix", "-0.1", "[0, 1]"}},
    {{"--max-growth", "-1"}, {"--max-growth", "-1", "[0, inf)"}},
    {{"--threads", "0"}, {"--threads", "0", "[1, 1024]"}},
    {{"--memory-limit", "0"}, {"--memory-limit", "0", "(0, inf)"}},
    {{"--memory-limit", "-4"}, {"--memory-limit", "-4", "(0, inf)"}},
    {{"--memory-limit", "8GB"}, {"--memory-limit", "'8GB'", "(0, inf)"}},
    {{"--steps", "-1"}, {"--steps", "-1", "[0, inf)"}},
    {{"--measure-every", "0"}, {"--measure-every", "0", "[1, inf)"}},
    {{"--steps", "40", "--measure-every", "50"}, {"--measure-every: 50", "--steps 40", "1 to 40"}},
    {{"--repeats", "0"}, {"--repeats", "0", "[1, inf)"}},
    {{"--skip", "-1"}, {"--skip", "-1", "[0, inf)"}},
    {{"--steps", "40", "--skip", "40"}, {"--skip: 40", "--steps 40"}},
    {{"--out", "caf\xe9"}, {"'caf\\xe9' is not UTF-8"}},
    {{"--sweeps", "-1"}, {"--sweeps", "-1", "[0, inf)"}},
    {{"--seed", "-1"}, {"--seed", "'-1'", "[0, 2^64)"}},
    {{"--bodies", "0"}, {"--bodies", "0", "[1, "}},
    {{"--mass", "-5"}, {"--mass", "-5", "["}},
    {{"--mass", "10,-5"}, {"--mass", "-5", "["}},
    {{"--rock-shape", "egg"}, {"--rock-shape", "'egg'", "box"}},
    {{"--links", "5"}, {"--links", "rock_pile", "--bodies", "--rock-shape", "--mass"}},
    {{"--scene", "rock_pil"}, {"--scene"}},
    {{"--partitioner", "mindq"}, {"--partitioner", "'mindq'", "'mindp'", "maxdp", "bfs"}},
    {{"--partitioner", "mindp,mindp"}, {"--partitioner", "'mindp'", "twice"}},
    {{"--partitioner", ""}, {"--partitioner", "''", "mindp"}},
    {{"--refiner", "fn"}, {"--refiner", "'fn'", "'fm'", "none"}},
    {{"--objective", "time"}, {"--objective", "'time'", "rows", "cost"}},
    {{"--objective", "cost", "--refiner", "kl"}, {"--objective", "refiner 'kl'", "none,fm"}},
    {{"--objective", "cost", "--refiner", "fm@as-printed=true"},
     {"--refiner", "as-printed is a parameter of", "fm-cost has"}},
    {{"--objective", "cost", "--refiner", "fm,fm-cost"}, {"--refiner", "'fm-cost'", "twice"}},
    {{"--objective", "cost", "--refiner", "fm", "--partitioner", "multilevel-cost,multilevel"},
     {"--partitioner", "'multilevel-cost'", "twice"}},
    {{"--objective", "cost", "--partitioner", "multilevel@seeds=2"},
     {"--partitioner", "seeds", "multilevel-cost"}},
    {{"--calibration", "shipped"}, {"--calibration", "refiner fm-cost", "nothing in this run has it"}},
    {{"--refiner", "fm-cost", "--calibration", "no_such_file"},
     {"--calibration", "'no_such_file'", "shipped"}},
    {{"--solver", "shcur"}, {"--solver", "'shcur'", "'schur'", "monolithic"}},
    {{"--solver", "all"}, {"--solver", "'all'", "schur"}},
    {{"--advance", "exakt"}, {"--advance", "'exakt'", "'exact'"}},
    {{"--strategy", "pivott"}, {"--strategy", "'pivott'", "'pivot'"}},
    {{"--kernel", "schur-row"}, {"--kernel", "'schur-row'", "'schur-rows'"}},
    {{"--solver", "pgs", "--kernel", "dense"}, {"--solver", "'pgs'"}},
    {{"--friction", "boks"}, {"--friction", "'boks'", "'box'", "constant"}},
    {{"--friction", "constant"}, {"--friction", "constant needs friction-force-n", "--friction-force-n"}},
    {{"--friction-force-n", "3"}, {"--friction-force-n", "friction constant", "nothing in this run"}},
    {{"--friction", "constant", "--friction-force-n", "-3"}, {"--friction-force-n", "-3", "[0, inf)"}},
    {{"--friction", "constant", "--friction-force-n", "3", "--ode-friction", "pyramid", "--solver",
      "ode-step"},
     {"--ode-friction", "pyramid", "--friction constant"}},
    {{"--ode-friction", "cone"}, {"--ode-friction", "cone", "pyramid"}},
    {{"--partitioner", "mindp@tau-mr=5"},
     {"--partitioner", "tau-mr is a parameter of partitioner mr", "mindp has"}},
    {{"--partitioner", "mindp@max-bodies=0"}, {"--partitioner mindp@max-bodies", "0 is not in [1, inf)"}},
    {{"--partitioner", "mindp@max-bodies"}, {"--partitioner", "name@parameter=value"}},
    {{"--steps", "2147483648"}, {"--steps: 2147483648 is not in [0, 2147483647]"}},
    {{"--repeats", "99999999999999999999"}, {"--repeats: 99999999999999999999 is not in [1, 2147483647]"}},
    {{"--partitioner", "mindp", "--tau-mr", "5"},
     {"--tau-mr", "partitioner mr", "nothing in this run has it"}},
    {{"--partitioner", "mindp@max-bodies=10,bfs@max-bodies=20", "--max-bodies", "30"},
     {"--max-bodies", "would do nothing", "mindp@max-bodies=10, bfs@max-bodies=20"}},
    {{"--solver", "exact", "--partitioner", "mix", "--max-bodies", "7"},
     {"--max-bodies", "parameter of mix, and no solver of this run splits bodies"}},
    {{"--solver", "alternate:schur-rows", "--kernel", "dense"},
     {"--kernel", "'dense' does not go with strategy alternate", "alternate:schur-rows", "allowed: schur-"}},
    {{"--solver", "pivot:dense", "--strategy", "alternate"},
     {"--strategy", "'alternate' does not go with kernel dense", "allowed: pivot"}},
    {{"--partitioner", "all@max-bodies=5"}, {"--partitioner", "'all@max-bodies=5'", "takes no parameters"}},
    {{"--friction", "box@mu=1", "--mu", "0.3"}, {"--mu", "would do nothing", "box@mu=1"}},
    {{"--sweeps", "5"}, {"--sweeps", "solvers pgs, pgs-colored", "nothing in this run has it"}},
    {{"--solver", "schur@sweeps=5"}, {"--solver", "sweeps is a parameter of solvers pgs, "}},
    {{"--solver", "pgs@sweeps=x"}, {"--solver pgs@sweeps", "'x' is not a whole number"}},
    {{"--friction", "none", "--mu", "0.5"}, {"--mu", "frictions box, box-converged", "nothing in this run"}},
    {{"--friction", "none@mu=0.5"}, {"--friction", "mu is a parameter of"}},
    {{"--scene", "rock_pile@links=5"}, {"--scene"}},
    {{"--mode", "lokstep"}, {"--mode", "'lokstep'", "'lockstep'", "separate"}},
    {{"--mode", "separate", "--advance", "exact"}, {"--advance", "lockstep"}},
    {{"--edge-weight", "row"}, {"--edge-weight", "'row'", "'rows'"}},
    {{"--degree", "body"}, {"--degree", "'body'"}},
    {{"--degree-scope", "all"}, {"--degree-scope", "'all'", "whole", "left"}},
    {{"--stiffness", "1000"}, {"--damping", "required"}},
    {{"--damping", "10"}, {"--stiffness", "required"}},
    {{"--stiffness", "0", "--damping", "10"}, {"--stiffness", "0", "(0, inf)"}},
    {{"--stiffness", "1000", "--damping", "10", "--erp", "0.1"}, {"--erp", "--stiffness"}},
    {{"--stiffness", "1000", "--damping", "10", "--cfm", "0.1"}, {"--cfm", "--stiffness"}},
    {{"--stpes", "5"}, {"--stpes", "--steps"}},
    {{"--stpes=5"}, {"--stpes", "--steps"}},
    {{"--steps"}, {"--steps"}},
    {{"--mu", "1", "--mu", "2"}, {"--mu"}},
    {{"stray"}, {"'stray'"}},
};

TEST(BadInput, IsOneLineExitCodeOneAndLeavesNothing) {
  const TemporaryDirectory directory;
  const std::string out = directory / "not" / "made";
  for (const BadInput& bad : kBadInputs) {
    std::vector<std::string> arguments = {"run", "--scene", "rock_pile", "--out", out};
    arguments.insert(arguments.end(), bad.arguments.begin(), bad.arguments.end());
    const ProgramResult result = run_cleave(arguments);
    const std::string what = joined(bad.arguments, " ") + " -> " + result.err;
    EXPECT_EQ(result.exit_code, 1) << what;
    EXPECT_EQ(count_lines(result.err), 1) << what;
    EXPECT_TRUE(result.err.starts_with("cleave run: ")) << what;
    EXPECT_EQ(result.out, "") << what;
    for (const std::string& piece : bad.pieces)
      EXPECT_NE(result.err.find(piece), std::string::npos) << piece << " in " << what;
    EXPECT_TRUE(fs::is_empty(directory.path())) << what;
  }
}

TEST(BadInput, RequiredOptionsAndNames) {
  const TemporaryDirectory directory;
  const std::string out = directory / "out";
  EXPECT_NE(
      run_cleave({"run", "--out", out, "--scene", "rock_pile@bodies=30", "--bodies", "40"})
          .err.find("--bodies: would do nothing, as all that have it say their own: rock_pile@bodies=30"),
      std::string::npos);
  EXPECT_NE(run_cleave({"run", "--out", out}).err.find("--scene: is required"), std::string::npos);
  EXPECT_NE(run_cleave({"run", "--scene", "rock_pile"}).err.find("--out: is required"), std::string::npos);
  const ProgramResult scene = run_cleave({"run", "--scene", "rock_pil", "--out", out});
  EXPECT_EQ(scene.exit_code, 1);
  EXPECT_NE(scene.err.find("did you mean 'rock_pile'?"), std::string::npos) << scene.err;
  EXPECT_NE(scene.err.find("chain_drop"), std::string::npos) << scene.err;
  const ProgramResult command = run_cleave({"rum"});
  EXPECT_EQ(command.exit_code, 1);
  EXPECT_NE(command.err.find("did you mean 'run'?"), std::string::npos) << command.err;
  EXPECT_EQ(run_cleave({}).exit_code, 1);
  EXPECT_TRUE(fs::is_empty(directory.path()));
}

TEST(BadInput, OutputDirectoryThatCannotBe) {
  const TemporaryDirectory directory;
  const fs::path file = directory / "file";
  std::ofstream(file) << "text";
  for (const std::string& out :
       {file.string(), (file / "below").string(), std::string("/proc/cleave/out"), std::string()}) {
    const ProgramResult result = run_cleave({"run", "--scene", "rock_pile", "--steps", "0", "--out", out});
    EXPECT_EQ(result.exit_code, 1) << out;
    EXPECT_EQ(count_lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find("--out: '" + out + "'"), std::string::npos) << result.err;
  }
  EXPECT_EQ(read_text(file), "text");
}

TEST(OutputDirectory, IsOverwrittenOnlyWithForce) {
  const TemporaryDirectory directory;
  const std::vector<std::string> arguments = {"run",     "--scene", "rock_pile", "--bodies",       "2",
                                              "--steps", "0",       "--out",     directory / "a/b"};
  ASSERT_EQ(run_cleave(arguments).exit_code, 0);
  std::ofstream(directory / "a/b/steps.csv") << "precious\n";
  const ProgramResult refused = run_cleave(arguments);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("--force"), std::string::npos) << refused.err;
  EXPECT_EQ(read_text(directory / "a/b/steps.csv"), "precious\n");
  std::vector<std::string> forced = arguments;
  forced.push_back("--force");
  EXPECT_EQ(run_cleave(forced).exit_code, 0);
  EXPECT_NE(read_text(directory / "a/b/steps.csv"), "precious\n");
}

void expect_listed(const std::string& what, const std::vector<std::string>& names) {
  const ProgramResult result = run_cleave({"list", what, "--names"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out, joined(names, "\n") + "\n");
  const ProgramResult table = run_cleave({"list", what});
  for (const std::string& name : names)
    EXPECT_NE(table.out.find("  " + name + " "), std::string::npos) << name;
}

TEST(List, ShowsTheRegistries) {
  expect_listed("scenes", names_of(scenes()));
  expect_listed("partitioners", names_of(partitioners()));
  expect_listed("refiners", names_of(refiners()));
  std::vector<std::string> solvers = names_of(solver_table());
  for (const AlgorithmEntry& entry : ode_baselines()) solvers.push_back(entry.name);
  expect_listed("solvers", solvers);
  expect_listed("strategies", names_of(strategy_table()));
  std::vector<std::string> kernels = names_of(kernel_table());
  kernels.emplace_back(kChosenKernel);
  expect_listed("kernels", kernels);
  expect_listed("frictions", names_of(friction_models()));
  const ProgramResult wrong = run_cleave({"list", "partitoners"});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_NE(wrong.err.find("'partitioners'"), std::string::npos) << wrong.err;
}

TEST(Help, ShowsEveryOption) {
  const ProgramResult result = run_cleave({"run", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const OptionSpec& spec : run_option_specs())
    EXPECT_NE(result.out.find("--" + spec.name + " "), std::string::npos) << spec.name;
  for (const CommonParameter& common : common_parameters())
    EXPECT_NE(result.out.find("--" + common.parameter.name + " "), std::string::npos)
        << common.parameter.name;
  EXPECT_NE(result.out.find("--partitioner mindp@max-bodies=25,mindp@max-bodies=50"), std::string::npos);
  for (const SceneEntry& scene : scenes())
    for (const Parameter& parameter : scene.parameters)
      EXPECT_EQ(parameter.kind != Parameter::Kind::path,
                result.out.find("--" + parameter.name + " ") != std::string::npos)
          << parameter.name;
}

std::string texts(const std::vector<Algorithm>& algorithms) {
  std::vector<std::string> list;
  for (const Algorithm& algorithm : algorithms) list.push_back(algorithm.text);
  return joined(list, ",");
}

RunOptions parsed(std::map<std::string, std::string> given) {
  given.insert({{"scene", "rock_pile"}, {"out", "x"}});
  return parse_run_options(given);
}

// What an option prints is what it reads.
TEST(Options, EveryDefaultReadsBackAsItself) {
  const RunOptions defaults = default_run_options();
  for (const OptionSpec& spec : run_option_specs()) {
    const std::string text = spec.get(defaults);
    if (text.empty() || text == "nan") continue;
    RunOptions options = defaults;
    spec.set(options, text);
    EXPECT_EQ(spec.get(options), text) << spec.name;
  }
}

TEST(Options, EveryGivenValueArrives) {
  const RunOptions options = parsed({{"mu", "0.25"},
                                     {"partitioner", "mix,bfs"},
                                     {"refiner", "all"},
                                     {"dt", "0.01"},
                                     {"edge-weight", "pairs"},
                                     {"degree-scope", "left"},
                                     {"friction", "box-converged"},
                                     {"as-printed", "true"},
                                     {"max-bodies", "7"},
                                     {"max-growth", "0.5"},
                                     {"seed", "18446744073709551615"},
                                     {"bodies", "12"}});
  EXPECT_EQ(options.extract.mu, 0.25);
  EXPECT_EQ(options.extract.h_s, 0.01);
  EXPECT_EQ(options.extract.friction, FrictionModel::box_converged);
  EXPECT_EQ(texts(options.partitioners), "mix,bfs");
  EXPECT_EQ(texts(options.refiners), joined(names_of(refiners()), ","));
  const Settings& mix = options.partitioners[0].settings;
  EXPECT_EQ(mix.text("edge-weight"), "pairs");
  EXPECT_EQ(mix.text("degree-scope"), "left");
  EXPECT_TRUE(mix.flag("as-printed"));
  EXPECT_EQ(mix.integer("max-bodies"), 7);
  EXPECT_EQ(options.partitioners[1].settings.integer("max-bodies"), 7);
  EXPECT_EQ(options.seed, 18446744073709551615u);
  EXPECT_EQ(options.scene.settings.text("bodies"), "12");
  EXPECT_EQ(options.scene.settings.text("rock-shape"), "box");  // completed with the scene's default
  const auto found = std::ranges::find(options.refiners, std::string("fm"), &Algorithm::name);
  ASSERT_NE(found, options.refiners.end());
  const Settings& fm = found->settings;
  EXPECT_EQ(fm.number("max-growth"), 0.5);
  EXPECT_EQ(fm.text("edge-weight"), "pairs");
  EXPECT_TRUE(fm.flag("as-printed"));
}

// One setting of an algorithm beside another, each with its own values and those given for all.
TEST(Options, SettingsOfOneAlgorithmStandSideBySide) {
  const RunOptions options =
      parsed({{"partitioner", "mindp@max-bodies=9,mindp,mix@max-bodies=4@edge-weight=pairs"},
              {"refiner", "fm@edge-weight=constraints"},
              {"solver", "pgs@sweeps=30,pgs@sweeps=10,schur"},
              {"max-bodies", "7"},
              {"scene", "rock_pile@bodies=3"}});
  EXPECT_EQ(texts(options.partitioners), "mindp@max-bodies=9,mindp,mix@max-bodies=4@edge-weight=pairs");
  EXPECT_EQ(options.partitioners[0].settings.integer("max-bodies"), 9);
  EXPECT_EQ(options.partitioners[1].settings.integer("max-bodies"), 7);
  EXPECT_EQ(options.partitioners[2].settings.integer("max-bodies"), 4);
  EXPECT_EQ(options.refiners[0].settings.text("edge-weight"), "constraints");
  EXPECT_EQ(options.solvers[0].settings.integer("sweeps"), 30);
  EXPECT_EQ(options.scene.settings.integer("bodies"), 3);
}

// Two rows that differ in a cell differ in a column that says why.
TEST(Options, ThreadsThatOpenMPDoesNotGrantAreRefused) {
  const TemporaryDirectory directory;
  const ProgramResult result = run_program(
      "/usr/bin/env", {"OMP_THREAD_LIMIT=1", CLEAVE_PROGRAM, "run", "--scene", "rock_pile", "--bodies", "2",
                       "--steps", "1", "--threads", "2", "--out", directory / "out"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("grants 1 of 2 threads"), std::string::npos) << result.err;
}

TEST(Options, ALookOutThatIsNoNumberIsRefused) {
  const TemporaryDirectory directory;
  const ProgramResult result = run_program(
      "/usr/bin/env", {"CLEAVE_LOOK_OUT_US=soon", CLEAVE_PROGRAM, "run", "--scene", "rock_pile", "--bodies",
                       "2", "--steps", "1", "--threads", "2", "--out", directory / "out"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("CLEAVE_LOOK_OUT_US: 'soon' is not a whole number"), std::string::npos)
      << result.err;
}

TEST(Options, EveryOptionThatCanChangeACellHasAColumn) {
  const std::map<std::string, std::string> renamed = {
      {"dt", "dt_s"}, {"gravity", "gravity_m_per_s2"}, {"repeats", "repeat_count"}};
  // Which rows there are, where they go, what --stiffness and --damping make of cfm and erp, --objective of
  // refiners, and what rows that it refuses name in their reason.
  const std::set<std::string> not_in_a_cell = {"measure-every", "skip",         "out",     "force",
                                               "record-motion", "stiffness",    "damping", "memory-limit",
                                               "objective",     "explain-model"};
  std::set<std::string> names;
  for (const Column& column : columns()) names.insert(column.name);
  for (const OptionSpec& spec : run_option_specs()) {
    std::string column = spec.name;
    std::ranges::replace(column, '-', '_');
    if (renamed.contains(spec.name)) column = renamed.at(spec.name);
    EXPECT_NE(names.contains(column), not_in_a_cell.contains(spec.name)) << spec.name;
  }
}

TEST(Options, GivenValuesStandInTheRows) {
  const TemporaryDirectory directory;
  const ProgramResult result = run_cleave({"run",
                                           "--scene",
                                           "rock_pile",
                                           "--bodies",
                                           "2",
                                           "--rock-shape",
                                           "sphere",
                                           "--steps",
                                           "2",
                                           "--solver",
                                           "schur,pgs,ode-step,ode-quickstep",
                                           "--partitioner",
                                           "mix",
                                           "--refiner",
                                           "fm",
                                           "--dt",
                                           "0.25",
                                           "--cfm",
                                           "0.125",
                                           "--erp",
                                           "0.5",
                                           "--gravity",
                                           "1.5",
                                           "--friction",
                                           "constant",
                                           "--friction-force-n",
                                           "2.5",
                                           "--match-tolerance",
                                           "0.0625",
                                           "--contact-cap",
                                           "3",
                                           "--edge-weight",
                                           "pairs",
                                           "--degree",
                                           "constraints",
                                           "--degree-scope",
                                           "whole",
                                           "--as-printed",
                                           "--skip-small-islands",
                                           "--sweeps",
                                           "7",
                                           "--predictor-sweeps",
                                           "9",
                                           "--max-iterations",
                                           "50",
                                           "--reuse-analysis",
                                           "--quickstep-iterations",
                                           "11",
                                           "--ode-step-max-rows",
                                           "13",
                                           "--advance",
                                           "monolithic",
                                           "--out",
                                           directory / "out"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const CsvTable table = read_csv(directory / "out/steps.csv");
  const std::map<std::string, std::string> expected = {
      {"dt_s", "0.25"},
      {"mu", "-"},
      {"cfm", "0.125"},
      {"erp", "0.5"},
      {"gravity_m_per_s2", "1.5"},
      {"friction_force_n", "2.5"},
      {"match_tolerance", "0.0625"},
      {"contact_cap", "3"},
      {"edge_weight", "pairs"},
      {"degree", "constraints"},
      {"degree_scope", "whole"},
      {"as_printed", "1"},
      {"skip_small_islands", "1"},
      {"predictor_sweeps", "9"},
      {"max_iterations", "50"},
      {"reuse_analysis", "1"},
      {"cold", "0"},
      {"mode", "lockstep"},
      {"advance", "monolithic"},
      {"steps", "2"},
      {"scene_options", "bodies=2;depth=3;mass=100;rock-shape=sphere"},
      {"schema_version", kStepsSchema}};
  for (const auto& [column, value] : expected) EXPECT_EQ(table.at(0, column), value) << column;
  // Each row has what its own algorithms have.
  const std::map<std::string, std::string> of_others = {{"sweeps", "-,7,-,-"},
                                                        {"predictor_sweeps", "9,-,-,-"},
                                                        {"max_iterations", "50,-,-,-"},
                                                        {"quickstep_iterations", "-,-,-,11"},
                                                        {"ode_step_max_rows", "-,-,13,-"},
                                                        {"edge_weight", "pairs,-,-,-"}};
  for (const auto& [column, values] : of_others)
    EXPECT_EQ(joined(std::vector<std::string>{table.at(0, column), table.at(1, column), table.at(2, column),
                                              table.at(3, column)},
                     ","),
              values)
        << column;
}

TEST(Options, FrictionWordsFollowTheEnumeration) {
  for (const FrictionModelEntry& entry : friction_models()) {
    std::map<std::string, std::string> given = {{"friction", entry.name}};
    if (entry.model == FrictionModel::constant) given["friction-force-n"] = "1";
    EXPECT_EQ(parsed(given).extract.friction, entry.model) << entry.name;
  }
}

// A spring k with damper d integrated implicitly over h: erp / cfm = h k and (1 - erp) / cfm = d.
TEST(Options, StiffnessAndDampingBecomeErpAndCfm) {
  const RunOptions options = parsed({{"stiffness", "5000"}, {"damping", "40"}, {"dt", "0.02"}});
  EXPECT_NEAR(options.extract.erp / options.extract.cfm, 0.02 * 5000, 1e-10);
  EXPECT_NEAR((1 - options.extract.erp) / options.extract.cfm, 40, 1e-10);
}

TEST(Options, StrategyAndKernelReplaceHalvesOfSolverNames) {
  const auto solvers = [](const std::map<std::string, std::string>& given) {
    return texts(parsed(given).solvers);
  };
  EXPECT_EQ(solvers({{"solver", "schur"}, {"strategy", "interior-point"}}), "interior-point:schur-rows");
  EXPECT_EQ(solvers({{"solver", "schur"}, {"kernel", "monolithic"}}), "pivot:monolithic");
  EXPECT_EQ(solvers({{"solver", "interior-point:dense"}, {"kernel", "monolithic"}}),
            "interior-point:monolithic");
  EXPECT_EQ(solvers({{"solver", "schur@max-iterations=9"}, {"kernel", "schur-bodies"}}),
            "pivot:schur-bodies@max-iterations=9");
  EXPECT_THROW(parsed({{"solver", "schur,monolithic"}, {"kernel", "dense"}}),
               std::invalid_argument);  // the same twice
}

TEST(Options, RunIdDependsOnTheExperimentOnly) {
  const std::string id = run_id(parsed({}));
  EXPECT_EQ(id.size(), 16u);
  EXPECT_EQ(run_id(parsed({{"threads", "2"}, {"out", "elsewhere"}, {"force", "true"}})), id);
  EXPECT_EQ(run_id(parsed({{"mu", "0.5"}})), id);  // the default said aloud
  for (const auto& [name, value] : std::map<std::string, std::string>{{"mu", "0.6"},
                                                                      {"seed", "2"},
                                                                      {"bodies", "5"},
                                                                      {"steps", "3"},
                                                                      {"refiner", "fm"},
                                                                      {"as-printed", "true"}})
    EXPECT_NE(run_id(parsed({{name, value}})), id) << name;
}

}  // namespace
}  // namespace cleave
