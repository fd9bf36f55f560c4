// cleave record: simulates and writes the problem of chosen steps, one file each.
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include "harness/base/numbers.h"
#include "harness/commands/command.h"
#include "harness/commands/run_command_line.h"
#include "harness/commands/simulate.h"
#include "harness/experiment/options.h"
#include "harness/files/manifest.h"
#include "harness/files/problem_file.h"
#include "harness/world/extract_shapes.h"

namespace cleave {
namespace {

using Given = std::map<std::string, std::string>;

// Parts are there for --advance alone, which is one solver.
void keep_one(const Given& given, const std::string& option, std::vector<Algorithm>& algorithms) {
  if (given.contains(option) && algorithms.size() > 1)
    throw std::invalid_argument("--" + option + ": '" + given.at(option) +
                                "' are several; name one, for the parts of --advance");
  algorithms.resize(1);
}

// Only the solver of --advance runs: where it ignores parts, options about them would do nothing.
void check_parts_wanted(const RepeatedOptions& all, const RunOptions& options) {
  if (uses_parts(options.advance)) return;
  for (const char* option : {"partitioner", "refiner", "skip-small-islands"})
    if (all.given.contains(option) && !all.stored.contains(option))
      throw std::invalid_argument(std::string("--") + option + ": --advance " + options.advance.text +
                                  " does not use it; allowed with a solver that works on parts");
}

RunOptions parse_record_options(const Given& typed) {
  RepeatedOptions all = with_config(typed, "record", &CommandSet::record, {"at"});
  const auto at = all.given.extract("at");
  if (at.empty()) throw std::invalid_argument("--at: is required: the steps to record, such as 100,200,300");
  // One solver and one way to split: what no part of them has is refused as in any run.
  Given one = all.given;
  std::set<std::string> not_typed = all.stored;
  const RunOptions defaults = default_run_options();
  for (const auto& [name, first] : {std::pair("partitioner", &defaults.partitioners.front()),
                                    std::pair("refiner", &defaults.refiners.front())})
    if (one.emplace(name, first->text).second) not_typed.insert(name);
  if (one.contains("advance")) read_named("advance", one["advance"]);  // errors name what was given
  one["solver"] = one.contains("advance") ? one["advance"] : defaults.advance.text;
  RunOptions options = parse_run_options(one, not_typed);
  check_parts_wanted(all, options);
  keep_one(all.given, "partitioner", options.partitioners);
  keep_one(all.given, "refiner", options.refiners);
  options.at = parse_integers("--at", at.mapped(), {0, std::numeric_limits<int>::max() - 1});
  options.steps = options.at.back() + 1;
  return options;
}

std::vector<std::string> files_of(const RunOptions& options) {
  std::vector<std::string> files = {kStepsFile};
  for (const int step : options.at) files.push_back(problem_file_name(options.scene.name, step));
  return files;
}

ProblemFile problem_file_of(const ObservedStep& step, const RunOptions& options) {
  const OdeWorld& world = *step.context.world;
  ProblemFile file;
  file.problem = step.problem;
  file.scene = options.scene.text;
  file.step = step.step;
  file.seed = options.seed;
  file.friction_model = options.friction.text;
  file.erp = options.extract.erp;
  file.cfm = options.extract.cfm;
  file.position = world.positions_m();
  if (!step.context.body_group.empty()) file.body_group = step.context.body_group;
  for (int i = 0; i < world.body_count(); ++i) {
    const BodyState state = world.state(i);
    file.orientation.insert(file.orientation.end(), state.orientation.begin(), state.orientation.end());
  }
  file.shapes = extract_shapes(world);
  return file;
}

int record(const Given& given, const std::vector<std::string>& argv) {
  const RunOptions options = parse_record_options(given);
  const std::filesystem::path out = options.out;
  const auto write = [&](const ObservedStep& step) {
    if (step.rows.empty()) return;
    const std::string name = problem_file_name(options.scene.name, step.step);
    write_problem_file(out / name, problem_file_of(step, options));
    for (StepRecord& row : step.rows) row.problem_file = name;
  };
  return simulate("record", argv, options, files_of(options), write);
}

}  // namespace

std::function<int()> declare_record(CLI::App& app, const std::vector<std::string>& argv) {
  const auto given = std::make_shared<Given>();
  app.add_option_function<std::string>(
         "--at", [given](const std::string& text) { (*given)["at"] = text; }, "steps to record")
      ->type_name("N,N,...");
  declare_run_options(app, *given, &CommandSet::record);
  return [given, argv] { return record(*given, argv); };
}

}  // namespace cleave
