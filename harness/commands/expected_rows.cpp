#include "harness/commands/expected_rows.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "harness/base/combination_label.h"
#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/option_values.h"
#include "harness/experiment/options.h"
#include "harness/experiment/step_columns.h"
#include "harness/files/problem_file.h"

namespace cleave {
namespace {

double number_of(const StoredManifest& manifest, const std::string& option) {
  return parse_number(option, manifest.option(option), {});
}

int integer_of(const StoredManifest& manifest, const std::string& option) {
  constexpr double kMost = std::numeric_limits<int>::max();
  return parse_integer(option, manifest.option(option), {0, kMost});
}

bool flag_of(const StoredManifest& manifest, const std::string& option) {
  return manifest.option(option) == "true";
}

// What was given for all algorithms, or their default.
CommonValues common_values(const StoredManifest& manifest) {
  CommonValues values;
  for (const CommonParameter& common : common_parameters())
    if (const std::string text = manifest.option(common.parameter.name); !text.empty())
      values[common.parameter.name] = text;
  return values;
}

// By its name and the parameters that the run gave it: one that reads files cannot be read again without
// them.
Algorithm stored_algorithm(const StoredManifest& manifest, const std::string& kind, const std::string& text) {
  if (content_of(kind, algorithm_name(text)) == nullptr)
    return read_named(kind, text, common_values(manifest));
  for (const NamedAlgorithm& named : manifest.algorithms)
    if (named.kind == kind && named.text == text) return {text, named.name, Settings(named.parameters)};
  throw std::invalid_argument("algorithms do not name the " + kind + " " + text);
}

std::vector<Algorithm> stored_list(const StoredManifest& manifest, const std::string& kind) {
  std::vector<Algorithm> list;
  for (const std::string& text : split_list(manifest.option(kind)))
    list.push_back(stored_algorithm(manifest, kind, text));
  return list;
}

std::string scene_options(const StoredManifest& manifest) {
  check_algorithm("scene", manifest.option("scene"));
  return scene_options_cell(parameters_of("scene", algorithm_name(manifest.option("scene"))),
                            [&](const std::string& name) { return manifest.option(name); });
}

StepRecord world_columns(const StoredManifest& manifest) {
  StepRecord row;
  row.scene = manifest.option("scene");
  row.seed = parse_seed("seed", manifest.option("seed"));
  row.friction = manifest.option("friction");
  row.add_parameters(read_named("friction", row.friction, common_values(manifest)).settings);
  row.dt_s = number_of(manifest, "dt");
  row.cfm = number_of(manifest, "cfm");
  row.erp = number_of(manifest, "erp");
  row.gravity_m_per_s2 = number_of(manifest, "gravity");
  row.match_tolerance = number_of(manifest, "match-tolerance");
  row.contact_cap = integer_of(manifest, "contact-cap");
  row.mode = manifest.option("mode");
  if (row.mode == "lockstep") row.advance = manifest.option("advance");
  row.steps = integer_of(manifest, "steps");
  row.scene_options = scene_options(manifest);
  row.cold = 0;
  return row;
}

}  // namespace

ExpectedRows::ExpectedRows(const StoredManifest& manifest) {
  is_replay_ = manifest.command == "replay";
  if (!is_replay_) common_ = world_columns(manifest);
  if (is_replay_) common_.cold = flag_of(manifest, "cold");
  if (const std::string name = manifest.option("friction"); is_replay_ && !name.empty())
    check_name("friction", name, recorded_friction_models());
  common_.run_id = manifest.run_id;
  common_.threads = integer_of(manifest, "threads");
  common_.repeat_count = integer_of(manifest, "repeats");
  common_.skip_small_islands = flag_of(manifest, "skip-small-islands");
  common_.session = flag_of(manifest, "session");
  common_.repartition = manifest.option("repartition");
  if (common_.repartition.empty()) common_.repartition = Repartition().text;  // record has no such option
  common_.body_order = manifest.option("body-order");
  if (common_.body_order.empty()) common_.body_order = BodyOrder().text;  // nor this one
  common_.model = manifest.option("model");
  if (common_.model.empty()) common_.model = "full";  // nor this one
  separate_ = common_.mode == "separate";
  add_combinations(manifest);
  if (is_replay_) {
    std::istringstream files(manifest.option("files"));
    for (std::string file; std::getline(files, file);) files_.push_back(file);
    problems_ = files_.size();
  } else {
    read_steps(manifest);
  }
}

// In the order of make_combinations, which would have to open the files of those that read files.
void ExpectedRows::add_combinations(const StoredManifest& manifest) {
  const std::vector<Algorithm> solvers = stored_list(manifest, "solver");
  const auto add = [this](const Algorithm& partitioner, const Algorithm& refiner, const Algorithm& solver) {
    StepRecord row;
    row.partitioner = partitioner.text;
    row.refiner = refiner.text;
    row.solver = solver.text;
    for (const Algorithm* algorithm : {&partitioner, &refiner, &solver})
      row.add_parameters(algorithm->settings);
    combinations_.push_back(row);
  };
  for (const Algorithm& partitioner : stored_list(manifest, "partitioner"))
    for (const Algorithm& refiner : stored_list(manifest, "refiner"))
      for (const Algorithm& solver : solvers)
        if (uses_parts(solver)) add(partitioner, refiner, solver);
  const Algorithm ignored{"-", "-", {}};
  for (const Algorithm& solver : solvers)
    if (!uses_parts(solver)) add(ignored, ignored, solver);
}

void ExpectedRows::read_steps(const StoredManifest& manifest) {
  if (manifest.command == "record") {
    steps_ = parse_integers("at", manifest.option("at"), {0, std::numeric_limits<int>::max() - 1});
    for (const int step : steps_) files_.push_back(problem_file_name(algorithm_name(common_.scene), step));
  } else {
    const int every = std::max(1, integer_of(manifest, "measure-every"));
    for (int step = every - 1; step < common_.steps; step += every) steps_.push_back(step);
  }
  problems_ = steps_.size();
}

std::size_t ExpectedRows::problem(std::size_t index) const {
  return separate_ ? index % problems_ : index / combinations_.size();
}

std::size_t ExpectedRows::combination(std::size_t index) const {
  return separate_ ? index / problems_ : index % combinations_.size();
}

StepRecord ExpectedRows::row(std::size_t index) const {
  const StepRecord& named = combinations_[combination(index)];
  const std::size_t at = problem(index);
  StepRecord row = common_;
  row.partitioner = named.partitioner;
  row.refiner = named.refiner;
  row.solver = named.solver;
  for (const auto& [column, cell] : named.parameters) row.add_parameter(column, cell);
  if (!files_.empty()) row.problem_file = files_[at];
  if (is_replay_) return row;
  row.step = steps_[at];
  row.time_s = row.step * row.dt_s;
  return row;
}

std::string ExpectedRows::key(std::size_t index) const {
  const StepRecord row = this->row(index);
  return row_key(is_replay() ? row.problem_file : std::to_string(row.step), row.partitioner, row.refiner,
                 row.solver);
}

std::string row_key(const std::string& step_or_file, const std::string& partitioner,
                    const std::string& refiner, const std::string& solver) {
  return "step " + step_or_file + " " + combination_label(partitioner, refiner, solver);
}

std::string run_id_of(const StoredManifest& manifest) {
  std::vector<OptionValue> values = manifest.options;
  for (OptionValue& value : values) {
    value.in_run_id = value.name != "files";
    const OptionSpec* of_table = find_option(value.name);
    if (of_table == nullptr) continue;
    value.in_run_id = of_table->in_run_id;
    // A number of the table that was not given has this text.
    if (value.text.empty() && of_table->kind == OptionKind::number) value.text = "nan";
  }
  return run_id(values);
}

}  // namespace cleave
