#include "harness/experiment/rest_islands.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "solver/residual.h"
#include "solver/step_solver.h"

namespace cleave {

double rest_limit_m_per_s(const StepProblem& problem) {
  double largest = 1;
  for (const double velocity : problem.free_velocity) largest = std::max(largest, std::abs(velocity));
  return SolveOptions{}.target_m_per_s * largest;
}

int RestIslands::root_of(int body) {
  while (parent_[body] != body) body = parent_[body] = parent_[parent_[body]];
  return body;
}

void RestIslands::join_bodies(const StepProblem& problem) {
  parent_.resize(problem.body_count());
  std::iota(parent_.begin(), parent_.end(), 0);
  int last_a = -1, last_b = -1;  // rows of a pair mostly follow each other
  for (int row = 0; row < problem.row_count(); ++row) {
    const int a = problem.row_body[2 * row], b = problem.row_body[2 * row + 1];
    if (a >= 0 && b >= 0 && (a != last_a || b != last_b)) parent_[root_of(a)] = root_of(b);
    last_a = a;
    last_b = b;
  }
  for (int body = 0; body < problem.body_count(); ++body) parent_[body] = root_of(body);
}

// One of each island; it is never a friction row, whose normal row comes before it.
void RestIslands::ask_for_first_rows(const StepProblem& problem) {
  is_at_rest_.resize(problem.rhs.size());
  is_moving_.assign(problem.body_count(), 1);
  for (int row = 0; row < problem.row_count(); ++row) {
    char& is_new = is_moving_[island_of(problem, row)];
    is_at_rest_[row] = is_new;
    is_new = 0;
  }
}

// Returns whether there is any.
bool RestIslands::ask_for_islands_at_rest(const StepProblem& problem) {
  is_at_rest_.resize(problem.rhs.size());
  for (int row = 0; row < problem.row_count(); ++row)
    is_at_rest_[row] = is_moving_[island_of(problem, row)] == 0;
  return std::ranges::find(is_at_rest_, 1) != is_at_rest_.end();
}

// Where a residual is no number, the island is not at rest. Returns whether any moves.
bool RestIslands::mark_moving(const StepProblem& problem) {
  const double limit = rest_limit_m_per_s(problem);
  const std::vector<double> residual =
      rough_row_residuals(problem, problem.warm_impulse, is_at_rest_, velocity_);
  bool any = false;
  for (int row = 0; row < problem.row_count(); ++row) {
    if (residual[row] <= limit) continue;
    is_moving_[island_of(problem, row)] = 1;
    any = true;
  }
  return any;
}

void RestIslands::restore_moving(const StepProblem& problem) {
  for (int body = 0; body < problem.body_count(); ++body)
    if (is_moving_[parent_[body]] != 0)
      std::copy_n(&problem.free_velocity[6 * body], 6, &velocity_[6 * body]);
}

void RestIslands::take(const StepProblem& problem, std::vector<char> is_at_rest) {
  is_at_rest_ = std::move(is_at_rest);
  velocity_ = problem.free_velocity;
  std::vector<double> impulse = problem.warm_impulse;
  for (int row = 0; row < problem.row_count(); ++row)
    if (is_at_rest_[row] == 0) impulse[row] = 0;
  row_residuals(problem, impulse, is_at_rest_, velocity_);
}

// Nearly every island that moves is told by its first row, so that the judge need not look at all of it;
// where something rested in the step before it does so at once.
const std::vector<char>& RestIslands::find(const StepProblem& problem) {
  velocity_ = problem.free_velocity;
  join_bodies(problem);
  if (has_rested_) {
    is_moving_.assign(problem.body_count(), 0);
  } else {
    ask_for_first_rows(problem);
    mark_moving(problem);
  }
  has_rested_ = ask_for_islands_at_rest(problem);
  if (has_rested_ && mark_moving(problem)) has_rested_ = ask_for_islands_at_rest(problem);
  restore_moving(problem);
  return is_at_rest_;
}

}  // namespace cleave
