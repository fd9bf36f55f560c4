// cleave record: simulates and writes the problem of chosen steps, one file each.
#include <algorithm>
#include <array>
#include <cstdio>
#include <initializer_list>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "harness/commands/command.h"
#include "harness/commands/run_command_line.h"
#include "harness/commands/simulate.h"
#include "harness/extract_shapes.h"
#include "harness/nearest_name.h"
#include "harness/options.h"
#include "harness/options_text.h"
#include "harness/output_directory.h"
#include "harness/problem_file.h"
#include "harness/solver_choices.h"

namespace cleave {
namespace {

using Given = std::map<std::string, std::string>;

// One solver advances the world and nothing is compared, so the options about that mean nothing here.
bool has_option(const std::string& name) {
  constexpr std::array<std::string_view, 8> without = {"solver", "strategy",      "kernel", "mode",
                                                       "steps",  "measure-every", "skip",   "record-motion"};
  return std::ranges::find(without, name) == without.end();
}

// Parts are there for --advance alone, which is one solver.
void keep_one(const Given& given, const std::string& option, std::vector<std::string>& names) {
  if (given.contains(option) && names.size() > 1)
    throw std::invalid_argument("--" + option + ": '" + joined(names, ",") +
                                "' are several; name one, for the parts of --advance");
  names.resize(1);
}

bool uses_parts(const RunOptions& options) { return make_solver(options.advance, options)->uses_partition(); }

// "" for a solver that has none.
std::string strategy_of(const std::string& solver) {
  const std::size_t colon = solver.find(':');
  if (colon != std::string::npos) return solver.substr(0, colon);
  for (const SolverRow& row : solver_table())
    if (row.entry.name == solver && row.strategy != nullptr) return row.strategy;
  return "";
}

bool has_strategy(const RunOptions& options) { return !strategy_of(options.advance).empty(); }

// What --advance must be for an option to mean anything.
struct UsedBy {
  const char* option;
  bool (*used)(const RunOptions& options);
  const char* by;
};
constexpr const char* kParts = "a solver that works on parts";
constexpr const char* kStrategies = "a solver with a strategy";

// The parts are those of the first partitioner and refiner.
bool splits_with(const RunOptions& options, std::initializer_list<std::string_view> names) {
  return uses_parts(options) && std::ranges::any_of(names, [&](std::string_view name) {
           return name == options.partitioners.front() || name == options.refiners.front();
         });
}

bool advances_with(const RunOptions& options, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, options.advance) != names.end();
}

constexpr UsedBy kUsedBy[] = {
    {"partitioner", uses_parts, kParts},
    {"refiner", uses_parts, kParts},
    {"max-bodies", uses_parts, kParts},
    {"tau-mr", [](const RunOptions& o) { return splits_with(o, {"mr"}); }, "parts by mr"},
    {"tau-mix", [](const RunOptions& o) { return splits_with(o, {"mix"}); }, "parts by mix"},
    {"max-growth", [](const RunOptions& o) { return splits_with(o, {"fm"}); }, "parts refined by fm"},
    {"edge-weight",
     [](const RunOptions& o) {
       return splits_with(o, {"mix", "kl", "fm"});
     },
     "parts by mix, or refined by kl or fm"},
    {"degree",
     [](const RunOptions& o) {
       return splits_with(o, {"mindp", "maxdp", "mix"});
     },
     "parts by mindp, maxdp or mix"},
    {"degree-scope",
     [](const RunOptions& o) {
       return splits_with(o, {"mindp", "maxdp", "mix"});
     },
     "parts by mindp, maxdp or mix"},
    {"as-printed",
     [](const RunOptions& o) {
       return splits_with(o, {"maxdp", "mix", "kl", "fm"});
     },
     "parts by maxdp or mix, or refined by kl or fm"},
    {"skip-small-islands", uses_parts, kParts},
    {"max-iterations", has_strategy, kStrategies},
    {"reuse-analysis", has_strategy, kStrategies},
    {"predictor-sweeps",
     [](const RunOptions& options) {
       const std::string strategy = strategy_of(options.advance);
       return strategy == "pivot" || strategy == "auto";
     },
     "a solver of strategy pivot or auto"},
    {"sweeps", [](const RunOptions& o) { return advances_with(o, {"pgs"}); }, "pgs"},
    {"quickstep-iterations", [](const RunOptions& o) { return advances_with(o, {"ode-quickstep"}); },
     "ode-quickstep"},
    {"ode-step-max-rows", [](const RunOptions& o) { return advances_with(o, {"ode-step"}); }, "ode-step"},
    {"ode-friction",
     [](const RunOptions& o) {
       return advances_with(o, {"ode-step", "ode-quickstep"});
     },
     "ode-step or ode-quickstep"},
};

// Only the solver of --advance runs, so an option that it does not use would do nothing.
void check_used(const Given& given, const RunOptions& options) {
  for (const UsedBy& row : kUsedBy)
    if (given.contains(row.option) && !row.used(options))
      throw std::invalid_argument(std::string("--") + row.option + ": --advance " + options.advance +
                                  (uses_parts(options) ? " on parts by " + options.partitioners.front() +
                                                             "+" + options.refiners.front()
                                                       : "") +
                                  " does not use it; allowed with " + row.by);
}

RunOptions parse_record_options(Given given) {
  const auto at = given.extract("at");
  if (at.empty()) throw std::invalid_argument("--at: is required: the steps to record, such as 100,200,300");
  RunOptions options = parse_run_options(given);
  check_used(given, options);
  keep_one(given, "partitioner", options.partitioners);
  keep_one(given, "refiner", options.refiners);
  options.solvers = {options.advance};
  options.at = parse_integers("at", at.mapped(), {0, std::numeric_limits<int>::max() - 1});
  options.steps = options.at.back() + 1;
  return options;
}

std::string file_name(const RunOptions& options, int step) {
  char number[16];
  std::snprintf(number, sizeof number, "%06d", step);
  return options.scene + "_step" + number + ".h5";
}

std::vector<std::string> files_of(const RunOptions& options) {
  std::vector<std::string> files = {"steps.csv"};
  for (const int step : options.at) files.push_back(file_name(options, step));
  return files;
}

ProblemFile problem_file_of(const OdeWorld& world, const StepProblem& problem, const StepRecord& common,
                            const RunOptions& options) {
  ProblemFile file;
  file.problem = problem;
  file.scene = common.scene;
  file.step = common.step;
  file.seed = common.seed;
  file.friction_model = common.friction;
  file.erp = options.extract.erp;
  file.cfm = options.extract.cfm;
  for (int i = 0; i < world.body_count(); ++i) {
    const BodyState state = world.state(i);
    file.position.insert(file.position.end(), state.position_m.begin(), state.position_m.end());
    file.orientation.insert(file.orientation.end(), state.orientation.begin(), state.orientation.end());
  }
  file.shapes = extract_shapes(world);
  return file;
}

int record(const Given& given, const std::vector<std::string>& argv) {
  const RunOptions options = parse_record_options(given);
  check_output_directory(options.out, options.force, files_of(options));
  const std::filesystem::path out = options.out;
  const auto write = [&](const OdeWorld& world, const StepProblem& problem, StepRecord& common) {
    common.problem_file = file_name(options, common.step);
    write_problem_file(out / common.problem_file, problem_file_of(world, problem, common, options));
  };
  return simulate("record", argv, options, write);
}

}  // namespace

std::function<int()> declare_record(CLI::App& app, const std::vector<std::string>& argv) {
  const auto given = std::make_shared<Given>();
  app.add_option_function<std::string>(
         "--at", [given](const std::string& text) { (*given)["at"] = text; }, "steps to record")
      ->type_name("N,N,...");
  declare_run_options(app, *given, has_option);
  declare_scene_options(app, *given);
  return [given, argv] { return record(*given, argv); };
}

}  // namespace cleave
