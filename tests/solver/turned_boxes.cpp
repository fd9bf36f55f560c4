#include "tests/solver/turned_boxes.h"

#include <algorithm>
#include <cmath>

#include "solver/registry.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

// The pairs (x_t1, x_t2) of `width` numbers a row, turned against the angle (to axes) or with it.
void turn_pairs(const StepProblem& problem, bool to_axes, int width, double* x) {
  for (std::size_t r = 0; r < problem.box_angle_rad.size(); ++r) {
    const double c = std::cos(problem.box_angle_rad[r]);
    const double s = (to_axes ? 1 : -1) * std::sin(problem.box_angle_rad[r]);
    for (int k = 0; k < width && problem.box_angle_rad[r] != 0; ++k) {
      double &first = x[(r + 1) * width + k], &second = x[(r + 2) * width + k];
      const double kept = first;
      first = c * kept + s * second;
      second = c * second - s * kept;
    }
  }
}

}  // namespace

std::vector<int> contacts_of(const StepProblem& problem) {
  std::vector<int> rows;
  for (int r = 0; r + 2 < problem.row_count(); ++r) {
    if (problem.friction_row[r + 1] == r && problem.friction_row[r + 2] == r) rows.push_back(r);
  }
  return rows;
}

StepProblem turn_boxes(StepProblem problem, std::uint64_t seed) {
  SeededRandom random(seed);
  problem.box_angle_rad.assign(problem.row_count(), 0.0);
  for (const int r : contacts_of(problem)) {
    if (random.chance(0.8)) problem.box_angle_rad[r] = random.uniform(-3, 3);
    for (int k = r + 1; k <= r + 2; ++k) problem.rhs[k] = random.uniform(-0.02, 0.02);
  }
  return problem;
}

StepProblem make_turned_pile(std::uint64_t seed, double cfm) {
  return turn_boxes(make_pile(seed, {.columns = 3, .rows = 2, .layers = 3, .cfm = cfm, .mass_ratio = 10}),
                    seed);
}

StepProblem in_turned_rows(const StepProblem& problem) {
  StepProblem turned = problem;
  turn_pairs(problem, true, 12, turned.jacobian.data());
  turn_pairs(problem, true, 1, turned.rhs.data());
  turned.box_angle_rad.clear();
  return turned;
}

std::vector<double> along_axes(const StepProblem& problem, std::span<const double> in_rows) {
  std::vector<double> result(in_rows.begin(), in_rows.end());
  turn_pairs(problem, true, 1, result.data());
  return result;
}

std::vector<double> along_rows(const StepProblem& problem, std::span<const double> in_axes) {
  std::vector<double> result(in_axes.begin(), in_axes.end());
  turn_pairs(problem, false, 1, result.data());
  return result;
}

Answer solve(const std::string& solver, const StepProblem& problem, const std::vector<int>& parts) {
  Answer answer{cold_start(problem), {}};
  answer.summary = make_step_solver(solver, {})->solve(problem, parts, answer.solution);
  return answer;
}

double largest_difference(std::span<const double> a, std::span<const double> b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace cleave
