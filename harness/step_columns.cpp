#include "harness/step_columns.h"

#include <algorithm>
#include <cmath>

#include "harness/friction.h"
#include "harness/hash.h"
#include "harness/problem_graph.h"

namespace cleave {
namespace {

std::string friction_name(FrictionModel model) {
  for (const FrictionModelEntry& entry : friction_models())
    if (entry.model == model) return entry.name;
  return "-";
}

int rows_of_kind(const StepProblem& problem, RowKind kind) {
  return static_cast<int>(std::ranges::count(problem.row_kind, kind));
}

}  // namespace

StepRecord run_columns(const RunOptions& options) {
  StepRecord row;
  row.run_id = run_id(options);
  row.scene = options.scene;
  row.seed = options.seed;
  row.friction = friction_name(options.extract.friction);
  row.threads = options.threads;
  row.max_bodies = options.partition.max_bodies;
  row.tau_mr = options.partition.tau_mr;
  row.tau_mix = options.partition.tau_mix;
  row.max_growth = options.max_growth;
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
