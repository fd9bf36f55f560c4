// cleave calibrate: times the solver on problems and fits the cost model of partition/cost_model.h to this
// machine.
//
// Every problem is split by several partitioners, refiners and sizes of part, and solved by each kernel of
// the model on one and on two threads, in rounds, the fastest of which counts: a core is not as fast in one
// minute as in the next. Every second source of problems is held out: the errors that are reported are those
// on what the fit has not seen. Solves that handed over to another strategy are left out of both, because
// they mix passes of two kinds.
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/base/printable_text.h"
#include "harness/base/progress.h"
#include "harness/commands/calibration_problems.h"
#include "harness/commands/check_arguments.h"
#include "harness/commands/command.h"
#include "harness/experiment/combination.h"
#include "harness/experiment/cost_fit.h"
#include "harness/experiment/problem_graph.h"
#include "harness/files/build_info.h"
#include "harness/files/whole_file.h"
#include "partition/calibration.h"
#include "solver/parallel_tasks.h"

namespace cleave {
namespace {

struct CalibrateOptions {
  std::vector<std::string> files;
  std::string out, repeats = "2", seed;  // empty: not given
  bool force = false;
};

constexpr const char* kSeed = "1";
constexpr int kThreads[] = {1, 2};
constexpr int kRounds = 3;
constexpr const char* kStrategy = "pivot:";

RunOptions solve_options(int threads, const std::string& repeats) {
  std::vector<std::string> partitioners = {"single"}, solvers;
  for (const char* name : {"mindp", "mix"})
    for (const char* max_bodies : {"10", "25", "50", "100"})
      partitioners.push_back(std::string(name) + "@max-bodies=" + max_bodies);
  for (const char* kernel : cost_kernel_names()) solvers.push_back(std::string(kStrategy) + kernel);
  return parse_solve_options({{"partitioner", joined(partitioners, ",")},
                              {"refiner", "none,fm"},
                              {"solver", joined(solvers, ",")},
                              {"threads", std::to_string(threads)},
                              {"repeats", repeats},
                              {"out", "-"}});
}

CostKernel kernel_of(const std::string& solver) {
  const auto names = cost_kernel_names();
  const auto found = std::ranges::find(names, solver.substr(std::string(kStrategy).size()));
  return static_cast<CostKernel>(found - names.begin());
}

CostGroup group_of(Stage stage) {
  switch (stage) {
    case Stage::analyze:
      return CostGroup::analysis;
    case Stage::factor_local:
      return CostGroup::local;
    case Stage::form_interface:
      return CostGroup::forming;
    case Stage::factor_interface:
      return CostGroup::interface;
    case Stage::solve:
    case Stage::refine:
      return CostGroup::substitution;
    default:
      return CostGroup::sweeps_and_assembly;
  }
}

// Stages are those of the median repeat, scaled to the fastest.
void set_times(const StepRecord& row, CostSample& sample) {
  sample.t_s_ms = row.t_s_min_ms;
  const double scale = row.t_s_min_ms / row.t_s_ms;
  const auto add = [&](CostGroup group, double ms) {
    sample.group_ms[static_cast<int>(group)] += scale * ms;
  };
  for (std::size_t stage = 0; stage < row.t_s_stage_ms.size(); ++stage)
    add(group_of(static_cast<Stage>(stage)), row.t_s_stage_ms[stage]);
  add(CostGroup::sweeps_and_assembly, row.t_s_other_ms);
}

CostSample sample_of(const StepRecord& row, const Partition& parts, const BodyGraph& graph, int cell) {
  CostSample sample{graph, parts, kernel_of(row.solver), row.threads};
  sample.factorizations = row.factorizations;
  sample.cell = cell;
  set_times(row, sample);
  if (sample.kernel == CostKernel::monolithic) sample.parts = {std::vector<int>(graph.body_count(), 0), 1};
  if (sample.kernel == CostKernel::schur_rows && row.interface_unknowns > 0)
    sample.active_share = interface_size(1e6 * row.factor_mflop_interface) / row.interface_unknowns;
  return sample;
}

// Samples of one number of threads, fitted and held out.
struct Samples {
  std::vector<CostSample> fitted, held_out;
  int handed_over = 0;
};

// All cells of one problem, each in its fastest round so far.
struct MeasuredProblem {
  std::vector<StepRecord> rows;
  std::vector<Partition> parts;  // the same in every round
};

void keep_fastest(MeasuredProblem&& round, MeasuredProblem& kept) {
  if (kept.rows.empty()) {
    kept = std::move(round);
    return;
  }
  for (std::size_t i = 0; i < kept.rows.size(); ++i)
    if (round.rows[i].t_s_min_ms < kept.rows[i].t_s_min_ms) kept.rows[i] = std::move(round.rows[i]);
}

std::vector<MeasuredProblem> measure_rounds(const std::vector<CalibrationProblem>& problems, int threads,
                                            const std::string& repeats) {
  const RunOptions options = solve_options(threads, repeats);
  StepContext context;
  std::vector<Combination> combinations = make_combinations(options, context);
  start_threads(threads);
  ProgressLine line("timing on " + std::to_string(threads));
  std::vector<MeasuredProblem> measured(problems.size());
  StepRecord blank;
  blank.threads = threads;
  const int count = static_cast<int>(problems.size());
  for (int visit = 0; visit < kRounds * count; ++visit) {
    const CalibrationProblem& at_hand = problems[visit % count];
    context.position_m = at_hand.position_m;
    MeasuredProblem round{std::vector<StepRecord>(combinations.size(), blank), {}};
    for (Outcome& outcome : measure_all(combinations, at_hand.problem, visit % count, round.rows))
      round.parts.push_back(std::move(outcome.parts));
    keep_fastest(std::move(round), measured[visit % count]);
    line.update(visit + 1, kRounds * count);
  }
  return measured;
}

void add_samples(const MeasuredProblem& measured, const BodyGraph& graph, std::size_t first_cell,
                 std::vector<CostSample>& half, int& handed_over) {
  for (std::size_t i = 0; i < measured.rows.size(); ++i) {
    const StepRecord& row = measured.rows[i];
    if (row.status != "ok" || row.factorizations < 1) continue;
    if (row.fallbacks > 0) {
      ++handed_over;
    } else {
      half.push_back(sample_of(row, measured.parts[i], graph, static_cast<int>(first_cell + i)));
    }
  }
}

Samples measure(const std::vector<CalibrationProblem>& problems, int threads, const std::string& repeats) {
  const std::vector<MeasuredProblem> measured = measure_rounds(problems, threads, repeats);
  Samples samples;
  std::set<std::string> sources;
  for (std::size_t k = 0; k < problems.size(); ++k) {
    sources.insert(problems[k].source);
    add_samples(measured[k], body_graph_of(problems[k].problem), sources.size() * measured[k].rows.size(),
                sources.size() % 2 == 1 ? samples.fitted : samples.held_out, samples.handed_over);
  }
  return samples;
}

std::vector<CostSample> of_kernel(const std::vector<CostSample>& samples, CostKernel kernel) {
  std::vector<CostSample> chosen;
  for (const CostSample& sample : samples)
    if (sample.kernel == kernel) chosen.push_back(sample);
  return chosen;
}

std::string percent(double error) { return number_text(std::round(1000 * error) / 10) + " %"; }

// Fits every kernel and says how good each fit is; the same words stand in the file.
void fit(const Samples& samples, int threads, std::vector<KernelCost>& costs,
         std::vector<std::pair<std::string, std::string>>& about) {
  for (std::size_t k = 0; k < cost_kernel_names().size(); ++k) {
    const CostKernel kernel = static_cast<CostKernel>(k);
    const std::vector<CostSample> fitted = of_kernel(samples.fitted, kernel);
    const std::vector<CostSample> held_out = of_kernel(samples.held_out, kernel);
    const std::string name =
        std::string(cost_kernel_names()[k]) + " on " + std::to_string(threads) + " threads";
    if (fitted.empty() || held_out.empty())
      throw std::runtime_error(name + ": no solve to fit, or none to hold out; name more FILES");
    costs.push_back(fit_cost(fitted));
    const std::string errors =
        std::to_string(fitted.size()) + " solves fitted, median error on " + std::to_string(held_out.size()) +
        " others " + percent(median_error(held_out, costs.back(), Knowledge::of_sample)) +
        " with what they factored, " +
        percent(median_error(held_out, costs.back(), Knowledge::of_partition)) +
        " from the partition alone, " + percent(median_cell_error(held_out, costs.back())) +
        " so of the sum over a scene's steps";
    say(name + ": " + errors);
    about.emplace_back("errors_" + std::string(cost_kernel_names()[k]) + "_" + std::to_string(threads),
                       errors);
  }
}

std::vector<std::pair<std::string, std::string>> about_this(const std::vector<std::string>& argv,
                                                            const CalibrateOptions& options) {
  const MachineInfo machine = machine_info();
  return {{"command", joined(argv, " ")},
          {"build", version_text(build_info())},
          {"host", machine.host},
          {"cpu", machine.cpu_model},
          {"cores", std::to_string(machine.cores)},
          {"load", number_text(machine.load_average[0])},
          {"seed", !options.files.empty() ? "-"
                   : options.seed.empty() ? kSeed
                                          : options.seed},
          {"utc", utc_now()}};
}

int calibrate(const CalibrateOptions& options, const std::vector<std::string>& argv) {
  check_out_file(options.out, options.force);
  check_not_read(options.out, std::vector<std::filesystem::path>(options.files.begin(), options.files.end()));
  if (!options.files.empty() && !options.seed.empty())
    throw std::invalid_argument("--seed: is of simulated scenes; leave it out beside problem files");
  const std::uint64_t seed = parse_seed("--seed", options.seed.empty() ? kSeed : options.seed);
  solve_options(1, options.repeats);  // whether --repeats is a number
  auto about = about_this(argv, options);
  const std::vector<CalibrationProblem> problems =
      options.files.empty() ? simulated_problems(seed) : recorded_problems(options.files);
  std::vector<KernelCost> costs;
  for (const int threads : kThreads) {
    const Samples samples = measure(problems, threads, options.repeats);
    fit(samples, threads, costs, about);
    if (samples.handed_over > 0)
      say(std::to_string(samples.handed_over) + " solves handed over to another strategy and are left out");
  }
  const std::string text = calibration_text(about, costs);
  write_whole_file(options.out, text);
  say(options.out + ": calibration " + parse_calibration(options.out, text).fingerprint);
  return kExitOk;
}

}  // namespace

std::function<int()> declare_calibrate(CLI::App& app, const std::vector<std::string>& argv) {
  const auto options = std::make_shared<CalibrateOptions>();
  app.add_option("files", options->files,
                 "problem files, every second of which is held out; without them steps of "
                 "shipped scenes are simulated")
      ->type_name("FILES");
  app.add_option("--out", options->out, "file to write")->type_name("PATH");
  app.add_option("--repeats", options->repeats,
                 "solves of each cell in each of three rounds, of which the fastest counts (2)")
      ->type_name("N");
  app.add_option("--seed", options->seed, "seed of the simulated scenes (1)")->type_name("N");
  app.add_flag("--force", options->force, "overwrite the file");
  return [options, argv] { return calibrate(*options, argv); };
}

}  // namespace cleave
