#include "harness/files/problem_file_defaults.h"

#include <algorithm>
#include <limits>

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Value>
void fill(std::vector<Value>& values, std::size_t count, Value value) {
  if (values.empty()) values.assign(count, value);
}

RowKind kind_of_bounds(double lower, double upper) {
  if (upper != kInfinity) return RowKind::friction;
  if (lower == -kInfinity) return RowKind::bilateral;
  return lower == 0 ? RowKind::normal : RowKind::friction;
}

// A row that names a normal row is friction; of all others the bounds tell.
std::vector<RowKind> kinds_of(const StepProblem& problem) {
  std::vector<RowKind> kinds;
  for (int r = 0; r < problem.row_count(); ++r)
    kinds.push_back(problem.friction_row[r] >= 0 ? RowKind::friction
                                                 : kind_of_bounds(problem.lower[r], problem.upper[r]));
  return kinds;
}

bool begins_constraint(const StepProblem& problem, int r) {
  if (r == 0) return true;
  for (const int side : {0, 1})
    if (problem.row_body[2 * r + side] != problem.row_body[2 * (r - 1) + side]) return true;
  if (problem.row_kind[r] == RowKind::friction) return false;
  return problem.row_kind[r] == RowKind::normal || problem.row_kind[r - 1] != RowKind::bilateral;
}

// A normal row begins a contact, to which the friction rows that follow it belong; bilateral rows in a row
// are one joint; other bodies are another constraint.
std::vector<int> constraints_of(const StepProblem& problem) {
  std::vector<int> ids;
  int id = -1;
  for (int r = 0; r < problem.row_count(); ++r) ids.push_back(id += begins_constraint(problem, r) ? 1 : 0);
  return ids;
}

}  // namespace

void fill_left_out(ProblemFile& file) {
  StepProblem& problem = file.problem;
  const std::size_t n = problem.body_count(), m = problem.row_count();
  fill(problem.friction_row, m, -1);
  fill(problem.friction_coefficient, m, 0.0);
  if (problem.row_kind.empty()) problem.row_kind = kinds_of(problem);
  if (problem.row_constraint.empty()) problem.row_constraint = constraints_of(problem);
  fill(problem.contact_point, 3 * m, 0.0);
  fill(problem.warm_impulse, m, 0.0);
  fill(file.position, 3 * n, 0.0);
  if (file.orientation.empty())
    for (std::size_t i = 0; i < n; ++i) file.orientation.insert(file.orientation.end(), {1.0, 0.0, 0.0, 0.0});
}

std::vector<double> known_positions(const ProblemFile& file) {
  const bool are_known =
      std::ranges::any_of(file.position, [](double coordinate) { return coordinate != 0; });
  return are_known ? file.position : std::vector<double>();
}

std::vector<int> known_groups(const ProblemFile& file) {
  return file.body_group.value_or(std::vector<int>());
}

}  // namespace cleave
