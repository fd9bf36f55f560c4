#include "harness/experiment/model_planner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/base/stopwatch.h"
#include "harness/experiment/row_subset.h"
#include "solver/residual.h"

namespace cleave {
namespace {

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

bool is_anything_solved(std::span<const RowPlan> plan) {
  return std::ranges::find(plan, RowPlan::solved) != plan.end();
}

// (m) 1 where that becomes of the row.
std::vector<char> rows_that_are(RowPlan what, std::span<const RowPlan> plan) {
  std::vector<char> are(plan.size());
  std::ranges::transform(plan, are.begin(), [what](RowPlan row) { return row == what; });
  return are;
}

void follow_normal_rows(const StepProblem& problem, std::vector<RowPlan>& plan) {
  for (int row = 0; row < problem.row_count(); ++row) {
    const int normal = problem.friction_row[row];
    if (normal >= 0 && plan[normal] != RowPlan::solved) plan[row] = plan[normal];
  }
}

// What the judge finds violated comes back, a friction row with its normal row. Returns how many rows did.
// judges_rest: rows at rest too.
int bring_back(const StepProblem& problem, std::span<const double> impulse, bool judges_rest,
               std::vector<RowPlan>& plan) {
  std::vector<char> is_asked(plan.size());
  std::ranges::transform(plan, is_asked.begin(), [judges_rest](RowPlan row) {
    return row == RowPlan::zero || (judges_rest && row == RowPlan::at_rest);
  });
  if (std::ranges::find(is_asked, 1) == is_asked.end()) return 0;
  const std::vector<double> residual = row_residuals(problem, impulse, is_asked);
  const double rest_limit = rest_limit_m_per_s(problem);
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

// Of rows with impulse 0, slacks are looked at where islands move.
void ModelPlanner::leave_out_separating(const StepProblem& problem, std::vector<RowPlan>& plan) const {
  const std::vector<double> slack = free_slack(problem), speed = violated_speed(problem, slack);
  std::vector<char> loaded(problem.rhs.size(), 0);
  for (int row = 0; row < problem.row_count(); ++row) {
    const int normal = problem.friction_row[row];
    if (normal < 0) continue;
    if (is_plain(problem, normal) && problem.lower[row] == 0 && problem.upper[row] == 0) {
      if (plan[row] == RowPlan::solved) plan[row] = RowPlan::zero;
    } else {
      loaded[normal] = 1;
    }
  }
  for (int row = 0; row < problem.row_count(); ++row) {
    if (plan[row] == RowPlan::solved && problem.row_kind[row] == RowKind::normal && !loaded[row] &&
        is_plain(problem, row) && separates(problem, row, slack, speed))
      plan[row] = RowPlan::zero;
  }
}

std::vector<RowPlan> ModelPlanner::plan(const StepProblem& problem) {
  std::vector<RowPlan> plan(problem.rhs.size());
  std::ranges::transform(rest_.find(problem), plan.begin(), [](char is_at_rest) {
    return is_at_rest != 0 ? RowPlan::at_rest : RowPlan::solved;
  });
  if (is_anything_solved(plan)) leave_out_separating(problem, plan);
  return plan;
}

// Where no row is left to solve the solver gets no bodies either.
void ModelPlanner::reduce(const StepProblem& problem) {
  if (is_plan_given_) rest_.take(problem, rows_that_are(RowPlan::at_rest, plan_));
  is_solved_ = rows_that_are(RowPlan::solved, plan_);
  if (is_anything_solved(plan_)) {
    copy_rows(problem, is_solved_, reduced_, new_row_);
    reduced_.free_velocity = rest_.velocity();
  } else {
    reduced_ = {};
    reduced_.h_s = problem.h_s;
  }
}

SolveSummary ModelPlanner::solve_reduced(StepSolver& solver, const Parts& parts) {
  if (reduced_.body_count() > 0) return solver.solve(reduced_, parts, found_);
  Parts none;
  none.kernel = parts.kernel;
  SolveSummary summary = solver.solve(reduced_, none, found_);
  summary.factorizations = 0;  // that of no bodies is none
  found_.velocity = rest_.velocity();
  return summary;
}

SolveSummary ModelPlanner::solve_pass(StepSolver& solver, const StepProblem& problem, const Parts& parts,
                                      Solution& solution) {
  if (std::ranges::count(plan_, RowPlan::solved) == problem.row_count())
    return solver.solve(problem, parts, solution);
  // Not the time from the solver's start to its end: that has in it what the solver does for its model of
  // workers.
  Stopwatch watch;
  reduce(problem);
  keep_rows(solution.impulse, is_solved_, found_.impulse);
  found_.velocity = solution.velocity;
  double own_ms = watch.lap_ms();
  SolveSummary summary = solve_reduced(solver, parts);
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
  plan_ = plan(problem);
  const std::ptrdiff_t left_out = problem.row_count() - std::ranges::count(plan_, RowPlan::solved);
  if (left_out < kLeastShare * problem.row_count()) std::ranges::fill(plan_, RowPlan::solved);
  const double plan_ms = watch.lap_ms();
  is_plan_given_ = false;
  SolveSummary summary = solve_planned(solver, problem, parts, solution, counts);
  add_serial_time(summary.times, plan_ms);
  return summary;
}

SolveSummary ModelPlanner::solve(StepSolver& solver, const StepProblem& problem, const Parts& parts,
                                 std::vector<RowPlan> plan, Solution& solution, ModelCounts& counts) {
  plan_ = std::move(plan);
  is_plan_given_ = true;
  return solve_planned(solver, problem, parts, solution, counts);
}

SolveSummary ModelPlanner::solve_planned(StepSolver& solver, const StepProblem& problem, const Parts& parts,
                                         Solution& solution, ModelCounts& counts) {
  follow_normal_rows(problem, plan_);
  counts = {static_cast<int>(std::ranges::count(plan_, RowPlan::zero)),
            static_cast<int>(std::ranges::count(plan_, RowPlan::at_rest)), 0, 1};
  SolveSummary summary = solve_pass(solver, problem, parts, solution);
  while (has_result(summary.status)) {
    Stopwatch watch;
    int returned = bring_back(problem, solution.impulse, is_plan_given_, plan_);
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
