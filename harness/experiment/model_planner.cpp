#include "harness/experiment/model_planner.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/base/stopwatch.h"
#include "harness/experiment/row_subset.h"
#include "solver/residual.h"

namespace cleave {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;  // of a symmetric one

// (m) J v0 - b.
std::vector<double> free_slack(const StepProblem& problem) {
  std::vector<double> slack(problem.rhs.size());
  for (int row = 0; row < problem.row_count(); ++row) {
    slack[row] = -problem.rhs[row];
    for (int side = 0; side < 2; ++side) {
      const int body = problem.row_body[2 * row + side];
      for (int k = 0; body >= 0 && k < 6; ++k)
        slack[row] += problem.jacobian[12 * row + 6 * side + k] * problem.free_velocity[6 * body + k];
    }
  }
  return slack;
}

// (n) The greatest speed at which a row of the body is violated.
std::vector<double> violated_speed(const StepProblem& problem, std::span<const double> slack) {
  std::vector<double> speed(problem.body_count(), 0.0);
  for (int row = 0; row < problem.row_count(); ++row) {
    if (problem.row_kind[row] == RowKind::friction) continue;
    const bool bilateral = problem.row_kind[row] == RowKind::bilateral;
    const double violated = bilateral ? std::abs(slack[row]) : std::max(0.0, -slack[row]);
    for (const int body : {problem.row_body[2 * row], problem.row_body[2 * row + 1]})
      if (body >= 0) speed[body] = std::max(speed[body], violated);
  }
  return speed;
}

// Its set is the interval of every row.
bool is_plain(const StepProblem& problem, int normal) {
  return (problem.contact_set.empty() || problem.contact_set[normal] == ContactSet::box) &&
         (problem.box_angle_rad.empty() || problem.box_angle_rad[normal] == 0);
}

bool separates(const StepProblem& problem, int row, std::span<const double> slack,
               std::span<const double> speed) {
  double margin = 0;
  for (const int body : {problem.row_body[2 * row], problem.row_body[2 * row + 1]})
    if (body >= 0) margin += speed[body];
  return problem.warm_impulse[row] == 0 && problem.lower[row] == 0 && slack[row] > margin;
}

void follow_normal_rows(const StepProblem& problem, std::vector<RowPlan>& plan) {
  for (int row = 0; row < problem.row_count(); ++row) {
    const int normal = problem.friction_row[row];
    if (normal >= 0 && plan[normal] != RowPlan::solved) plan[row] = plan[normal];
  }
}

double velocity_scale(const StepProblem& problem) {
  double largest = 1;
  for (const double velocity : problem.free_velocity) largest = std::max(largest, std::abs(velocity));
  return largest;
}

// What the judge finds violated comes back, a friction row with its normal row. Returns how many rows did.
int bring_back(const StepProblem& problem, std::span<const double> impulse, std::vector<RowPlan>& plan) {
  if (std::ranges::count(plan, RowPlan::solved) == problem.row_count()) return 0;
  std::vector<char> is_left_out(plan.size());
  std::ranges::transform(plan, is_left_out.begin(), [](RowPlan row) { return row != RowPlan::solved; });
  const std::vector<double> residual = row_residuals(problem, impulse, is_left_out);
  const double rest_limit = kRestReturn * velocity_scale(problem);
  int returned = 0;
  const auto back = [&](int row) {
    returned += std::exchange(plan[row], RowPlan::solved) != RowPlan::solved;
  };
  for (int row = 0; row < problem.row_count(); ++row) {
    if (plan[row] == RowPlan::solved || residual[row] <= (plan[row] == RowPlan::zero ? 0 : rest_limit))
      continue;
    back(row);
    if (problem.friction_row[row] >= 0) back(problem.friction_row[row]);
  }
  return returned;
}

// velocity (n, 6) += M^-1 J^T lambda of the rows at rest.
void add_impulses_at_rest(const StepProblem& problem, std::span<const RowPlan> plan,
                          std::vector<double>& velocity) {
  std::vector<double> sum(velocity.size(), 0.0);
  for (int row = 0; row < problem.row_count(); ++row) {
    for (int side = 0; plan[row] == RowPlan::at_rest && side < 2; ++side) {
      const int body = problem.row_body[2 * row + side];
      for (int k = 0; body >= 0 && k < 6; ++k)
        sum[6 * body + k] += problem.jacobian[12 * row + 6 * side + k] * problem.warm_impulse[row];
    }
  }
  for (int body = 0; body < problem.body_count(); ++body) {
    const Eigen::Map<const Vector6> impulse(&sum[6 * body]);
    if (impulse.isZero(0)) continue;
    const Eigen::Map<const Matrix6> mass(&problem.mass[36 * body]);
    Eigen::Map<Vector6>(&velocity[6 * body]) += mass.llt().solve(impulse);
  }
}

void add(double& sum, double value) { sum = std::isnan(sum) ? value : sum + value; }

// Sizes and words of `pass`, counts and times of both.
void add_pass(SolveSummary& sum, SolveSummary pass) {
  pass.iterations += sum.iterations;
  pass.factorizations += sum.factorizations;
  pass.factor_reuses += sum.factor_reuses;
  pass.cg_iterations += sum.cg_iterations;
  pass.fallbacks += sum.fallbacks;
  pass.refinements += sum.refinements;
  pass.engine_messages += sum.engine_messages;
  pass.factor_mflop_done += sum.factor_mflop_done;
  for (std::size_t i = 0; i < kStageNames.size(); ++i) add(pass.times.stage_ms[i], sum.times.stage_ms[i]);
  for (std::size_t i = 0; i < kModelWorkers.size(); ++i) pass.times.model_ms[i] += sum.times.model_ms[i];
  pass.times.critical_path_ms += sum.times.critical_path_ms;
  add(pass.times.total_ms, sum.times.total_ms);
  sum = std::move(pass);
}

// NaN, which was not measured, stays so.
void add_serial_time(StageTimes& times, double serial_ms) {
  times.total_ms += serial_ms;
  for (double& model_ms : times.model_ms) model_ms += serial_ms;
  times.critical_path_ms += serial_ms;
}

}  // namespace

std::vector<RowPlan> ModelPlanner::plan(const StepProblem& problem) {
  const std::vector<double> slack = free_slack(problem), speed = violated_speed(problem, slack);
  const std::vector<char>& is_at_rest = rest_.find(problem);
  std::vector<RowPlan> plan(problem.rhs.size(), RowPlan::solved);
  std::vector<char> loaded(problem.rhs.size(), 0);
  for (int row = 0; row < problem.row_count(); ++row) {
    const int normal = problem.friction_row[row];
    if (normal < 0) continue;
    if (is_plain(problem, normal) && problem.lower[row] == 0 && problem.upper[row] == 0) {
      plan[row] = RowPlan::zero;
    } else {
      loaded[normal] = 1;
    }
  }
  for (int row = 0; row < problem.row_count(); ++row) {
    if (is_at_rest[row]) {
      plan[row] = RowPlan::at_rest;
    } else if (problem.row_kind[row] == RowKind::normal && !loaded[row] && is_plain(problem, row) &&
               separates(problem, row, slack, speed)) {
      plan[row] = RowPlan::zero;
    }
  }
  return plan;
}

void ModelPlanner::reduce(const StepProblem& problem) {
  is_solved_.resize(plan_.size());
  std::ranges::transform(plan_, is_solved_.begin(), [](RowPlan row) { return row == RowPlan::solved; });
  copy_rows(problem, is_solved_, reduced_, new_row_);
  add_impulses_at_rest(problem, plan_, reduced_.free_velocity);
}

SolveSummary ModelPlanner::solve_pass(StepSolver& solver, const StepProblem& problem, const Parts& parts,
                                      Solution& solution) {
  if (std::ranges::count(plan_, RowPlan::solved) == problem.row_count())
    return solver.solve(problem, parts, solution);
  // Not the time from the solver's start to its end: that has in it what the solver does for its model of workers.
  Stopwatch watch;
  reduce(problem);
  keep_rows(solution.impulse, is_solved_, found_.impulse);
  found_.velocity = solution.velocity;
  double own_ms = watch.lap_ms();
  SolveSummary summary = solver.solve(reduced_, parts, found_);
  watch.lap_ms();
  solution.velocity = found_.velocity;
  for (int row = 0; row < problem.row_count(); ++row) {
    const bool is_solved = plan_[row] == RowPlan::solved;
    solution.impulse[row] = is_solved                        ? found_.impulse[new_row_[row]]
                            : plan_[row] == RowPlan::at_rest ? problem.warm_impulse[row]
                                                             : 0.0;
  }
  own_ms += watch.lap_ms();
  add_serial_time(summary.times, own_ms);
  return summary;
}

SolveSummary ModelPlanner::solve(StepSolver& solver, const StepProblem& problem, const Parts& parts,
                                 Solution& solution, ModelCounts& counts) {
  Stopwatch watch;
  std::vector<RowPlan> first = plan(problem);
  const std::ptrdiff_t left_out = problem.row_count() - std::ranges::count(first, RowPlan::solved);
  if (left_out < kLeastShare * problem.row_count()) std::ranges::fill(first, RowPlan::solved);
  const double plan_ms = watch.lap_ms();
  SolveSummary summary = solve(solver, problem, parts, std::move(first), solution, counts);
  add_serial_time(summary.times, plan_ms);
  return summary;
}

SolveSummary ModelPlanner::solve(StepSolver& solver, const StepProblem& problem, const Parts& parts,
                                 std::vector<RowPlan> plan, Solution& solution, ModelCounts& counts) {
  plan_ = std::move(plan);
  follow_normal_rows(problem, plan_);
  counts = {static_cast<int>(std::ranges::count(plan_, RowPlan::zero)),
            static_cast<int>(std::ranges::count(plan_, RowPlan::at_rest)), 0, 1};
  SolveSummary summary = solve_pass(solver, problem, parts, solution);
  while (has_result(summary.status)) {
    Stopwatch watch;
    int returned = bring_back(problem, solution.impulse, plan_);
    add_serial_time(summary.times, watch.lap_ms());
    if (returned == 0) break;
    if (counts.passes == kMostPasses - 1) {
      returned += problem.row_count() - static_cast<int>(std::ranges::count(plan_, RowPlan::solved));
      std::ranges::fill(plan_, RowPlan::solved);
    }
    counts.rows_returned += returned;
    ++counts.passes;
    add_pass(summary, solve_pass(solver, problem, parts, solution));
  }
  return summary;
}

}  // namespace cleave
