#include "harness/step_columns.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "harness/friction.h"
#include "harness/hash.h"
#include "harness/nearest_name.h"
#include "harness/problem_graph.h"

namespace cleave {
namespace {

std::string friction_name(FrictionModel model) {
  for (const FrictionModelEntry& entry : friction_models())
    if (entry.model == model) return entry.name;
  return "-";
}

// As it stands on the command line and in the manifest.
std::string option_text(const RunOptions& options, std::string_view name) {
  for (const OptionSpec& spec : run_option_specs())
    if (spec.name == name) return spec.get(options);
  throw std::logic_error("no option of this name: " + std::string(name));
}

std::string joined_scene_options(const RunOptions& options) {
  std::vector<std::string> pairs;
  for (const auto& [name, value] : options.scene_options) pairs.push_back(name + "=" + value);
  return pairs.empty() ? "-" : joined(pairs, ";");
}

void set_physics(const RunOptions& options, StepRecord& row) {
  row.dt_s = options.extract.h_s;
  row.mu = options.extract.mu;
  row.cfm = options.extract.cfm;
  row.erp = options.extract.erp;
  row.gravity_m_per_s2 = options.gravity_m_per_s2;
  if (options.extract.friction == FrictionModel::constant)
    row.friction_force_n = options.extract.friction_force_n;
  row.match_tolerance = options.match_tolerance;
  row.contact_cap = options.contact_cap;
}

int rows_of_kind(const StepProblem& problem, RowKind kind) {
  return static_cast<int>(std::ranges::count(problem.row_kind, kind));
}

}  // namespace

StepRecord solve_columns(const RunOptions& options) {
  StepRecord row;
  row.threads = options.threads;
  row.max_bodies = options.partition.max_bodies;
  row.tau_mr = options.partition.tau_mr;
  row.tau_mix = options.partition.tau_mix;
  row.max_growth = options.max_growth;
  row.edge_weight = option_text(options, "edge-weight");
  row.degree = option_text(options, "degree");
  row.degree_scope = option_text(options, "degree-scope");
  row.as_printed = options.partition.as_printed;
  row.skip_small_islands = options.skip_small_islands;
  row.sweeps = options.sweeps;
  row.predictor_sweeps = options.predictor_sweeps;
  row.max_iterations = options.max_iterations;
  row.reuse_analysis = options.reuse_analysis;
  return row;
}

StepRecord run_columns(const RunOptions& options) {
  StepRecord row = solve_columns(options);
  row.run_id = run_id(options);
  row.scene = options.scene;
  row.seed = options.seed;
  row.friction = friction_name(options.extract.friction);
  set_physics(options, row);
  row.cold = 0;
  row.quickstep_iterations = options.ode_baseline.quickstep_iterations;
  row.ode_step_max_rows = options.ode_baseline.step_max_rows;
  row.ode_friction = option_text(options, "ode-friction");
  row.mode = option_text(options, "mode");
  if (options.mode == RunMode::lockstep) row.advance = options.advance;
  row.steps = options.steps;
  row.scene_options = joined_scene_options(options);
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

double largest_difference(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size()) return kUnmeasured;
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = std::abs(a[i] - b[i]);
    if (!(difference <= largest)) largest = difference;
    if (std::isnan(largest)) return largest;
  }
  return largest;
}

}  // namespace cleave
