// Bad and odd input through the program, beyond the options that cli_test covers: parameters of every scene,
// the commands record and replay, and problems with nothing in them.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "harness/base/names.h"
#include "harness/experiment/problem_graph.h"
#include "partition/registry.h"
#include "scenarios/scene.h"
#include "tests/harness/problem_file_sample.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
// One line on stderr that holds all pieces, nothing on stdout, exit code 1, and an empty directory.
void expect_refused(const Arguments& arguments, const Arguments& pieces, const fs::path& directory) {
  const ProgramResult result = run_cleave(arguments);
  const std::string what = joined(arguments, " ") + " -> " + result.err;
  EXPECT_EQ(result.exit_code, 1) << what;
  EXPECT_EQ(count_lines(result.err), 1) << what;
  EXPECT_EQ(result.out, "") << what;
  for (const std::string& piece : pieces)
    EXPECT_NE(result.err.find(piece), std::string::npos) << piece << " in " << what;
  EXPECT_TRUE(fs::is_empty(directory)) << what;
}

Arguments bad_values(const Parameter& parameter) {
  switch (parameter.kind) {
    case Parameter::Kind::integer:
      return {std::to_string(std::llround(parameter.range.min) - 1),
              std::to_string(std::llround(parameter.range.max) + 1), "2.5", "many"};
    case Parameter::Kind::number:
    case Parameter::Kind::numbers:
      return {"-1", "nan", "inf", "heavy"};
    case Parameter::Kind::word:
      return {"no-such-choice"};
    case Parameter::Kind::flag:
      return {"maybe"};
    case Parameter::Kind::path:
    case Parameter::Kind::content:
      return {};  // what is wrong with a file is the scene's own matter
  }
  return {};
}

TEST(BadSceneOption, IsOneLineThatNamesOptionValueAndRange) {
  const TemporaryDirectory directory;
  for (const SceneEntry& scene : scenes())
    for (const Parameter& parameter : scene.parameters)
      for (const std::string& value : bad_values(parameter)) {
        const std::string option = "--" + std::string(parameter.name);
        const std::string allowed =
            parameter.kind == Parameter::Kind::word ? parameter.words[0] : std::string("[");
        expect_refused({"run", "--scene", scene.name, option, value, "--out", directory / "out"},
                       {option + ": ", value, allowed}, directory.path());
      }
}

TEST(BadInputOfRecord, IsRefusedBeforeAnythingIsCreated) {
  const TemporaryDirectory directory;
  const struct {
    Arguments arguments;
    Arguments pieces;
  } mistakes[] = {
      {{"--scene", "log_towr"}, {"--scene", "'log_towr'", "did you mean 'log_tower'?", "chain_drop"}},
      {{"--scene", "rock_pile", "--dt", "nan"}, {"--dt", "nan", "(0, inf)"}},
      {{"--scene", "rock_pile", "--dt", "0"}, {"--dt", "0", "(0, inf)"}},
      {{"--scene", "rock_pile", "--mu", "-0.5"}, {"--mu", "-0.5", "[0, inf)"}},
      {{"--scene", "rock_pile", "--mu", "nan"}, {"--mu", "nan", "[0, inf)"}},
      {{"--scene", "rock_pile", "--cfm", "nan"}, {"--cfm", "nan", "[0, inf)"}},
      {{"--scene", "rock_pile", "--bodies", "-3"}, {"--bodies", "-3", "[1, "}},
      {{"--scene", "rock_pile", "--mass", "1,0"}, {"--mass", "0", "["}},
      {{"--scene", "rock_pile", "--friction", "boxed"},
       {"--friction", "'boxed'", "did you mean 'box'?", "none"}},
      {{"--scene", "rock_pile", "--advance", "exact:schur"}, {"--advance", "'exact:schur'"}},
  };
  for (const auto& [arguments, pieces] : mistakes) {
    Arguments all = {"record", "--at", "3", "--out", directory / "out"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    expect_refused(all, pieces, directory.path());
  }
}

// All partitioners but `file`, each with all refiners.
std::size_t pairs_with_defaults() { return (partitioners().size() - 1) * refiners().size(); }

class Replays : public testing::Test {
 protected:
  // Writes the problem into a directory of its own and replays it into directory_/out.
  ProgramResult replay(const StepProblem& problem, const Arguments& more) {
    ProblemFile file = sample_file(problem.body_count());
    file.problem = problem;
    file.solutions.clear();
    file.partitions.clear();
    write_problem_file(files_ / "problem.h5", file);
    Arguments arguments = {"replay", files_ / "problem.h5", "--out", directory_ / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_cleave(arguments);
  }

  // All combinations of all solvers that must not miss: every row ok.
  CsvTable expect_ok(const StepProblem& problem, const std::string& max_bodies) {
    const ProgramResult result =
        replay(problem, {"--partitioner", "all", "--refiner", "all", "--solver",
                         "schur,interior-point:schur-bodies,auto:schur-rows,monolithic,dense,exact",
                         "--max-bodies", max_bodies, "--repeats", "1", "--force"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const CsvTable table = read_csv(directory_ / "out/steps.csv");
    EXPECT_EQ(table.rows.size(), pairs_with_defaults() * 3 + 3);
    for (const std::string& status : table.column("status")) EXPECT_EQ(status, "ok");
    for (const std::string& residual : table.column("residual_m_per_s")) EXPECT_LE(std::stod(residual), 1e-9);
    return table;
  }

  TemporaryDirectory files_, directory_;
};

TEST_F(Replays, RefuseBadOptionsBeforeAnythingIsCreated) {
  const struct {
    Arguments arguments;
    Arguments pieces;
  } mistakes[] = {
      {{"--partitioner", "mindegree"}, {"--partitioner", "'mindegree'", "mindp", "bfs"}},
      {{"--refiner", "kli"}, {"--refiner", "'kli'", "did you mean 'kl'?", "none"}},
      {{"--solver", "interior-point:schur-row"}, {"--solver", "'interior-point:schur-row'", "schur-rows"}},
      {{"--max-bodies", "0"}, {"--max-bodies", "0", "[1, inf)"}},
      {{"--tau-mr", "nan"}, {"--tau-mr", "nan", "(1, inf)"}},
      {{"--tau-mix", "2"}, {"--tau-mix", "2", "[0, 1]"}},
      {{"--max-growth", "-0.1"}, {"--max-growth", "-0.1", "[0, inf)"}},
      {{"--threads", "0"}, {"--threads", "0", "[1, 1024]"}},
  };
  for (const auto& [arguments, pieces] : mistakes) {
    const ProgramResult result = replay(sample_problem(5, 1), arguments);
    EXPECT_EQ(result.exit_code, 1) << joined(arguments, " ");
    EXPECT_EQ(count_lines(result.err), 1) << result.err;
    for (const std::string& piece : pieces)
      EXPECT_NE(result.err.find(piece), std::string::npos) << piece << " in " << result.err;
    EXPECT_TRUE(fs::is_empty(directory_.path())) << joined(arguments, " ");
  }
}

TEST_F(Replays, RefuseAnOutputDirectoryThatCannotBe) {
  std::ofstream(directory_ / "file") << "text";
  for (const char* command : {"replay", "record"}) {
    Arguments arguments = {command, "--out", directory_ / "file/below"};
    if (std::string(command) == "replay") {
      ASSERT_EQ(replay(sample_problem(5, 1), {}).exit_code, 0);
      arguments.push_back(files_ / "problem.h5");
    } else {
      arguments.insert(arguments.end(), {"--scene", "rock_pile", "--at", "0"});
    }
    const ProgramResult result = run_cleave(arguments);
    EXPECT_EQ(result.exit_code, 1) << command;
    EXPECT_EQ(count_lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find("--out: '" + (directory_ / "file/below").string() + "'"), std::string::npos)
        << result.err;
  }
  EXPECT_EQ(read_text(directory_ / "file"), "text");
}

// All bodies static: there is nothing to solve for.
TEST_F(Replays, RunWithoutADynamicBody) {
  const CsvTable table = expect_ok(sample_problem(0, 1), "25");
  EXPECT_EQ(table.at(0, "bodies"), "0");
  EXPECT_EQ(table.at(0, "parts"), "0");
  EXPECT_EQ(table.at(0, "islands"), "0");
}

TEST_F(Replays, RunOneBody) {
  const CsvTable table = expect_ok(sample_problem(1, 1), "25");
  EXPECT_EQ(table.at(0, "parts"), "1");
  EXPECT_EQ(table.at(0, "interface_unknowns"), "0");
}

// Bodies without rows fly on as they were.
TEST_F(Replays, RunBodiesThatTouchNothing) {
  StepProblem problem = sample_problem(0, 1);
  const StepProblem bodies = sample_problem(4, 1);
  problem.mass = bodies.mass;
  problem.free_velocity = bodies.free_velocity;
  const CsvTable table = expect_ok(problem, "25");
  EXPECT_EQ(table.at(0, "islands"), "4");
  EXPECT_EQ(table.at(0, "parts"), "4");
  for (const std::string& residual : table.column("residual_m_per_s")) EXPECT_EQ(std::stod(residual), 0);
}

TEST_F(Replays, RunOnePartForAllAndOnePartForEach) {
  EXPECT_EQ(expect_ok(sample_problem(7, 1), "1000").at(0, "parts"), "1");
  EXPECT_EQ(expect_ok(sample_problem(7, 1), "1").at(0, "parts"), "7");
}

// Three bodies and four that share no row: solved as if the others were not there.
TEST_F(Replays, RunIslandsThatShareNothing) {
  StepProblem problem = sample_problem(7, 1);
  problem.row_body[2 * 2] = 2, problem.row_body[2 * 2 + 1] = -1;  // the joint from body 2 to body 3
  ASSERT_EQ(count_islands(body_graph_of(problem)), 2);
  const CsvTable table = expect_ok(problem, "25");
  EXPECT_EQ(table.at(0, "islands"), "2");
  EXPECT_EQ(table.at(0, "parts"), "2");
  EXPECT_EQ(table.at(0, "interface_rows"), "0");
}

}  // namespace
}  // namespace cleave
