// cleave replay: solves recorded problems with every combination.
#include <algorithm>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "harness/base/names.h"
#include "harness/base/printable_text.h"
#include "harness/base/progress.h"
#include "harness/base/stop_signals.h"
#include "harness/base/stopwatch.h"
#include "harness/commands/check_arguments.h"
#include "harness/commands/command.h"
#include "harness/commands/manifested_work.h"
#include "harness/commands/run_command_line.h"
#include "harness/commands/stored_partition.h"
#include "harness/commands/turned_problem.h"
#include "harness/experiment/combination.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/option_overrides.h"
#include "harness/experiment/option_values.h"
#include "harness/experiment/options.h"
#include "harness/experiment/step_columns.h"
#include "harness/files/csv_recorder.h"
#include "harness/files/manifest.h"
#include "harness/files/output_directory.h"
#include "harness/files/problem_file.h"
#include "partition/registry.h"
#include "solver/parallel_tasks.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
using Given = std::map<std::string, std::string>;

struct ReplayOptions {
  RunOptions solve;
  std::vector<std::string> files;
  std::string friction;  // empty: as recorded
  bool cold = false;
  bool write_solutions = false;
};

// Everything about the step itself comes from the files.
bool in_replay(const std::string& option) {
  if (const OptionSpec* spec = find_option(option)) return spec->commands.replay;
  const CommonParameter* common = find_common_parameter(option);
  return common != nullptr && common->in_replay;
}

std::vector<OptionValue> values_of(const ReplayOptions& options) {
  std::vector<OptionValue> values;
  for (const OptionValue& value : option_values(options.solve))
    if (in_replay(value.name)) values.push_back(value);
  // A replay without it is the one it was before there was such an option.
  if (!options.friction.empty())
    values.push_back({"friction", OptionKind::text, options.friction, About::problem});
  const auto flag = [](bool set) { return std::string(set ? "true" : "false"); };
  values.push_back({"cold", OptionKind::flag, flag(options.cold), About::problem});
  values.push_back({"write-solutions", OptionKind::flag, flag(options.write_solutions)});
  values.push_back({"files", OptionKind::lines, joined(options.files, "\n"), About::bookkeeping, false});
  return values;
}

// The option for which files must be one simulation's steps, one after the other; empty: they may be any.
std::string asks_for_series(const RunOptions& options) {
  if (options.session) return "--session";
  return options.repartition.kind == Repartition::Kind::always ? ""
                                                               : "--repartition " + options.repartition.text;
}

// Before anything is created. What `all` stands for splits every file.
void check_files(ReplayOptions& options) {
  std::string without_groups;
  std::string before;
  std::vector<std::string> unturned;
  std::set<fs::path> seen;
  std::tuple<std::string, std::uint64_t, int, int> last;
  for (const std::string& path : options.files) {
    if (!seen.insert(fs::weakly_canonical(path)).second)
      throw std::invalid_argument("FILES: " + path + " is named twice");
    ProblemFile file = read_problem_file_aloud(path);
    if (!turn_friction(path, options.friction, file)) unturned.push_back(path);
    const std::tuple now{file.scene, file.seed, file.problem.body_count(), file.step};
    if (const std::string option = asks_for_series(options.solve);
        !option.empty() && !before.empty() && now != last)
      throw std::invalid_argument("FILES: " + path + " is not the step after that of " + before + ", which " +
                                  option + " asks for");
    if (!file.body_group) without_groups = path;
    before = path;
    last = now;
    ++std::get<3>(last);
  }
  if (!unturned.empty())
    say("--friction " + options.friction + ": " + std::to_string(unturned.size()) + " of " +
        std::to_string(options.files.size()) + " files have no contact with friction and stay as recorded, " +
        unturned.front() + " the first");
  if (without_groups.empty()) return;
  const auto why = [&](const Algorithm& partitioner) {
    return partitioner_row(partitioner.name).traits.needs_groups
               ? "which splits by groups of bodies, and " + without_groups + " names none"
               : std::string();
  };
  leave_out_of_all(why, options.solve);
}

// The files of --write-solutions must not meet each other or replace what is replayed.
void check_copies_differ(const ReplayOptions& options) {
  std::set<std::string> names;
  for (const std::string& file : options.files) {
    const fs::path copy = fs::path(options.solve.out) / fs::path(file).filename();
    std::error_code error;
    if (fs::equivalent(file, copy, error))
      throw std::invalid_argument("--out: the copy of " + file + " would replace it; name another directory");
    if (!names.insert(copy.filename()).second)
      throw std::invalid_argument(file + ": another file of this name is replayed; " + copy.string() +
                                  " cannot hold both");
  }
}

// --force takes away what an earlier command left in --out; that must not be what is replayed.
void check_not_taken_away(const ReplayOptions& options) {
  std::error_code error;
  for (const fs::path& earlier : files_of_earlier_work(options.solve.out))
    for (const std::string& file : options.files)
      if (fs::equivalent(file, earlier, error))
        throw std::invalid_argument(
            "--out: '" + options.solve.out + "' holds " + file +
            ", which is replayed and would be overwritten with the rest; name another directory");
}

std::vector<std::string> files_written(const ReplayOptions& options) {
  std::vector<std::string> files = {kStepsFile};
  if (!options.write_solutions) return files;
  for (const std::string& file : options.files) files.push_back(fs::path(file).filename());
  return files;
}

StepRecord columns_of(const ProblemFile& file, const std::string& path, const ReplayOptions& options) {
  StepRecord row = solve_columns(options.solve);
  row.run_id = run_id(values_of(options));
  row.scene = file.scene;
  row.seed = file.seed;
  row.step = file.step;
  row.time_s = file.step * file.problem.h_s;
  row.friction = file.friction_model;
  row.dt_s = file.problem.h_s;
  row.cfm = file.cfm;
  row.erp = file.erp;
  row.cold = options.cold;
  row.problem_file = path;
  set_problem_columns(file.problem, row);
  return row;
}

void store(const Combination& combination, const StepRecord& row, const Outcome& outcome, ProblemFile& file) {
  const std::string label = combination.name().label();
  file.solutions.erase(label);
  file.partitions.erase(label);
  if (!outcome.solved()) return;
  file.solutions[label] = {row.solver,
                           row.strategy,
                           row.kernel,
                           row.partitioner,
                           row.refiner,
                           outcome.verdict.residual_m_per_s,
                           outcome.solution.impulse,
                           outcome.verdict.velocity};
  if (outcome.parts.part_of_body.empty()) return;
  SplitSetup setup = combination.split_setup();
  setup.choice = outcome.parts.choice;
  file.partitions[label] =
      stored_partition(setup, outcome.parts.part_of_body, outcome.parts.parent_of_part, outcome.origin);
}

class Replay {
 public:
  // Makes every solver, partitioner and refiner.
  explicit Replay(const ReplayOptions& options)
      : options_(options), combinations_(make_combinations(options.solve, context_, &stop_requested())) {}

  RunSummary run(const fs::path& out) {
    Stopwatch watch;
    start_threads(options_.solve.threads);
    CsvRecorder recorder(out / kStepsFile, csv_header());
    ProgressLine line("replay");
    const int total = static_cast<int>(options_.files.size());
    try {
      for (int i = 0; i < total && !stop_requested(); ++i) {
        solve(options_.files[i], out, recorder);
        line.update(i + 1, total);
      }
    } catch (const Stopped&) {
      // The rows of the problem at hand are not all there, so none is written.
    }
    summary_.wall_s = watch.lap_ms() / 1000;
    summary_.interrupted = stop_requested();
    return summary_;
  }

 private:
  void solve(const std::string& path, const fs::path& out, CsvRecorder& recorder) {
    ProblemFile file = read_problem_file(path);
    turn_friction(path, options_.friction, file);
    std::vector<StepRecord> rows(combinations_.size(), columns_of(file, path, options_));
    std::vector<double> recorded = file.problem.warm_impulse;
    if (options_.cold) std::ranges::fill(file.problem.warm_impulse, 0.0);
    context_.position_m = known_positions(file);
    context_.body_group = known_groups(file);
    const std::vector<Outcome> outcomes =
        measure_all(combinations_, file.problem, summary_.measured_steps, rows);
    if (options_.write_solutions) {
      file.problem.warm_impulse = std::move(recorded);  // a copy of the file is of the same problem
      for (std::size_t i = 0; i < rows.size(); ++i) store(combinations_[i], rows[i], outcomes[i], file);
      write_problem_file(out / fs::path(path).filename(), file);
    }
    for (const StepRecord& row : rows) summary_.add(row);
    ++summary_.measured_steps;
    if (rows.front().contacts > 0) ++summary_.measured_with_contacts;
    recorder.append(csv_lines(rows));
  }

  const ReplayOptions& options_;
  StepContext context_;  // without a world
  std::vector<Combination> combinations_;
  RunSummary summary_;
};

int replay(ReplayOptions options, const std::vector<std::string>& argv) {
  if (options.files.empty()) throw std::invalid_argument("FILES: at least one problem file is required");
  check_files(options);
  if (options.write_solutions) check_copies_differ(options);
  check_not_taken_away(options);
  check_run_directory(options.solve.out, options.solve.force, files_written(options));
  Replay work(options);
  return do_manifested_work(
      options.solve, describe_work("replay", argv, options.solve, values_of(options), files_written(options)),
      [&] { return work.run(options.solve.out); });
}

// What is given beside --config wins; FILES do as a whole.
ReplayOptions with_stored(const Given& given, ReplayOptions options) {
  RepeatedOptions all =
      with_config(given, "replay", &CommandSet::replay, {"friction", "cold", "write-solutions", "files"});
  const auto take = [&](const char* name) {
    const auto node = all.given.extract(name);
    return node.empty() ? std::string() : node.mapped();
  };
  std::istringstream files(take("files"));
  if (options.files.empty())
    for (std::string file; std::getline(files, file);) options.files.push_back(file);
  if (const std::string stored = take("friction"); options.friction.empty()) options.friction = stored;
  if (options.friction.find('@') != std::string::npos)
    throw std::invalid_argument(
        "--friction: '" + options.friction +
        "' has parameters; replay takes the coefficients of the files, write --friction " +
        algorithm_name(options.friction));
  if (!options.friction.empty()) check_name("--friction", options.friction, recorded_friction_models());
  options.cold |= take("cold") == "true";
  options.write_solutions |= take("write-solutions") == "true";
  options.solve = parse_solve_options(all.given, all.stored);
  return options;
}

}  // namespace

std::function<int()> declare_replay(CLI::App& app, const std::vector<std::string>& argv) {
  struct State {
    Given given;
    ReplayOptions options;
  };
  const auto state = std::make_shared<State>();
  app.add_option("files", state->options.files, "problem files that cleave record wrote")->type_name("FILES");
  declare_run_options(app, state->given, &CommandSet::replay);
  app.add_option("--friction", state->options.friction,
                 "friction model of the contacts in place of the recorded one: " +
                     joined(recorded_friction_models(), ", "))
      ->type_name("NAME");
  app.add_flag("--cold", state->options.cold, "start from zero impulses in place of the recorded ones");
  app.add_flag("--write-solutions", state->options.write_solutions,
               "copy each file to --out with every solution and partition in it");
  return [state, argv] { return replay(with_stored(state->given, state->options), argv); };
}

}  // namespace cleave
