#include "harness/experiment/step_columns.h"

#include <algorithm>
#include <stdexcept>

#include "harness/base/hash.h"
#include "harness/base/names.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/option_values.h"
#include "harness/experiment/problem_graph.h"
#include "solver/problem_hash.h"

namespace cleave {
namespace {

void set_physics(const RunOptions& options, StepRecord& row) {
  row.dt_s = options.extract.h_s;
  row.cfm = options.extract.cfm;
  row.erp = options.extract.erp;
  row.gravity_m_per_s2 = options.gravity_m_per_s2;
  row.match_tolerance = options.match_tolerance;
  row.contact_cap = options.contact_cap;
}

int rows_of_kind(const StepProblem& problem, RowKind kind) {
  return static_cast<int>(std::ranges::count(problem.row_kind, kind));
}

}  // namespace

std::string scene_options_cell(const std::vector<Parameter>& parameters,
                               const std::function<std::string(const std::string& name)>& value_of) {
  std::vector<std::string> pairs;
  for (const Parameter& parameter : parameters)
    if (parameter.kind != Parameter::Kind::path)
      pairs.push_back(parameter.name + "=" + value_of(parameter.name));
  std::ranges::sort(pairs);
  return pairs.empty() ? "-" : joined(pairs, ";");
}

StepRecord solve_columns(const RunOptions& options) {
  StepRecord row;
  row.threads = options.threads;
  row.skip_small_islands = options.skip_small_islands;
  row.session = options.session;
  row.repartition = options.repartition.text;
  row.body_order = options.body_order.text;
  row.model = options.model == Model::full ? "full" : "auto";
  return row;
}

StepRecord run_columns(const RunOptions& options) {
  StepRecord row = solve_columns(options);
  row.run_id = run_id(options);
  row.scene = options.scene.text;
  row.seed = options.seed;
  row.friction = options.friction.text;
  row.add_parameters(options.friction.settings);
  set_physics(options, row);
  row.cold = 0;
  row.mode = find_option("mode")->get(options);
  if (options.mode == RunMode::lockstep) row.advance = options.advance.text;
  row.steps = options.steps;
  row.scene_options = scene_options_cell(scene_row(options.scene).parameters, [&](const std::string& name) {
    return options.scene.settings.text(name);
  });
  return row;
}

void set_problem_columns(const StepProblem& problem, StepRecord& row) {
  row.bodies = problem.body_count();
  row.rows = problem.row_count();
  row.rows_bilateral = rows_of_kind(problem, RowKind::bilateral);
  row.rows_normal = rows_of_kind(problem, RowKind::normal);
  row.rows_friction = rows_of_kind(problem, RowKind::friction);
  row.contacts = row.rows_normal;  // a contact point has one normal row
  row.islands = count_islands(body_graph_of(problem));
  row.problem_hash = hex(problem_hash(problem));
}

double deepest_m(std::span<const ContactPoint> contacts) {
  double deepest = 0;
  for (const ContactPoint& contact : contacts) deepest = std::max(deepest, contact.depth_m);
  return deepest;
}

}  // namespace cleave
