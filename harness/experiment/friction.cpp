#include "harness/experiment/friction.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "solver/gauss_seidel.h"

namespace cleave {
namespace {

const Parameter& mu() {
  static const Parameter parameter{.name = "mu",
                                   .kind = Parameter::Kind::number,
                                   .default_value = "0.5",
                                   .range = {0, std::numeric_limits<double>::infinity()},
                                   .help = "friction coefficient"};
  return parameter;
}

const Parameter& friction_force_n() {
  static const Parameter parameter{.name = "friction-force-n",
                                   .kind = Parameter::Kind::number,
                                   .range = {0, std::numeric_limits<double>::infinity()},
                                   .unit = "N",
                                   .help = "largest friction force along a tangent, N"};
  return parameter;
}

bool follows_normal(const StepProblem& problem, int row) { return problem.friction_coefficient[row] > 0; }

double coulomb_bound(const StepProblem& problem, int row, std::span<const double> impulse) {
  return problem.friction_coefficient[row] * std::max(0.0, impulse[problem.friction_row[row]]);
}

void set_bound(StepProblem& problem, int row, double bound) {
  problem.upper[row] = bound;
  problem.lower[row] = -bound;
}

double clamp_impulse(const StepProblem& problem, int row, double impulse, std::span<const double> others) {
  if (!follows_normal(problem, row)) return std::clamp(impulse, problem.lower[row], problem.upper[row]);
  const double bound = coulomb_bound(problem, row, others);
  return std::clamp(impulse, -bound, bound);
}

// The impulses after a few Gauss-Seidel sweeps in which friction bounds move with the normal impulses.
std::vector<double> predicted_impulse(const StepProblem& problem) {
  PreparedStep step;
  step.prepare(problem);
  std::vector<double> impulse(problem.row_count(), 0.0), velocity(problem.free_velocity);
  const auto start_warm = [&](int r, double, double) {
    return clamp_impulse(problem, r, problem.warm_impulse[r], impulse);
  };
  const auto relax = [&](int r, double old, double w) {
    return clamp_impulse(problem, r, old - w / step.diagonal()[r], impulse);
  };
  gauss_seidel_sweep(step, OrderedSlack{}, start_warm, impulse, velocity);
  for (int s = 0; s < kPredictionSweeps; ++s)
    gauss_seidel_sweep(step, OrderedSlack{}, relax, impulse, velocity);
  return impulse;
}

void set_coulomb_bounds(std::span<const double> impulse, StepProblem& problem) {
  for (int r = 0; r < problem.row_count(); ++r)
    if (follows_normal(problem, r)) set_bound(problem, r, coulomb_bound(problem, r, impulse));
}

}  // namespace

std::span<const FrictionModelEntry> friction_models() {
  static const FrictionModelEntry table[] = {
      {{"none", "no friction rows, one row a contact", "-"}, FrictionModel::none},
      {{"constant",
        "bound = h * friction-force-n, whatever the normal impulse",
        "ODE manual, contact mu as a force limit",
        {friction_force_n()}},
       FrictionModel::constant},
      {{"box",
        "bound = mu * normal impulse predicted by 5 Gauss-Seidel sweeps, then frozen",
        "pyramid of the ODE manual (dContactApprox1) with its bounds frozen",
        {mu()}},
       FrictionModel::box},
      {{"box-converged",
        "bound iterated to mu * normal impulse of the solution",
        "fixed point as in Kaufman et al., Staggered Projections, ACM TOG 27(5), 2008",
        {mu()}},
       FrictionModel::box_converged},
  };
  return table;
}

FrictionModel friction_model(const std::string& name) {
  for (const FrictionModelEntry& entry : friction_models())
    if (entry.name == name) return entry.model;
  throw std::logic_error("no friction model of this name: " + name);
}

void predict_friction_bounds(StepProblem& problem) {
  set_coulomb_bounds(predicted_impulse(problem), problem);
}

double bound_mismatch(const StepProblem& problem, std::span<const double> impulse) {
  assert(static_cast<int>(impulse.size()) == problem.row_count());
  double largest_bound = 0;
  for (int r = 0; r < problem.row_count(); ++r)
    if (follows_normal(problem, r))
      largest_bound = std::max(largest_bound, coulomb_bound(problem, r, impulse));
  const double floor = std::max(kBoundFloor * largest_bound, 1e-12);
  double mismatch = 0;
  for (int r = 0; r < problem.row_count(); ++r) {
    if (!follows_normal(problem, r)) continue;
    const double bound = coulomb_bound(problem, r, impulse);
    mismatch = std::max(mismatch, std::abs(problem.upper[r] - bound) / std::max(bound, floor));
  }
  return mismatch;
}

ConvergedBounds converge_friction_bounds(StepProblem& problem, StepSolver& solver, const Parts& parts,
                                         Solution& solution) {
  ConvergedBounds result;
  while (true) {
    result.last_summary = solver.solve(problem, parts, solution);
    ++result.solves;
    result.mismatch = bound_mismatch(problem, solution.impulse);
    if (result.last_summary.status != SolveStatus::ok) return result;
    result.converged = result.mismatch <= kBoundTolerance;
    if (result.converged || result.solves == kBoundIterationCap) return result;
    set_coulomb_bounds(solution.impulse, problem);
  }
}

}  // namespace cleave
