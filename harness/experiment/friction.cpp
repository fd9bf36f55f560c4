#include "harness/experiment/friction.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

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

using Block = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

bool follows_normal(const StepProblem& problem, int row) { return problem.friction_coefficient[row] > 0; }

double coulomb_bound(const StepProblem& problem, int row, std::span<const double> impulse) {
  return problem.friction_coefficient[row] * std::max(0.0, impulse[problem.friction_row[row]]);
}

void set_bound(StepProblem& problem, int row, double bound) {
  problem.upper[row] = bound;
  problem.lower[row] = -bound;
}

// Projected Gauss-Seidel in row order with the velocities kept up to date, as the prediction needs it: a few
// sweeps whose friction bounds move with the normal impulses.
class BoundPredictor {
 public:
  explicit BoundPredictor(const StepProblem& problem)
      : problem_(problem), velocity_(problem.free_velocity), impulse_(problem.row_count(), 0.0) {
    response_.resize(problem.jacobian.size());
    diagonal_ = problem.compliance;
    std::vector<Block> inverse_mass(problem.body_count());
    for (int i = 0; i < problem.body_count(); ++i)
      inverse_mass[i] = Eigen::Map<const Block>(&problem.mass[36 * i]).llt().solve(Block::Identity());
    for (int r = 0; r < problem.row_count(); ++r)
      for (int side = 0; side < 2; ++side) {
        const int body = problem.row_body[2 * r + side];
        if (body < 0) continue;
        const Eigen::Map<const Vector6> jacobian(&problem.jacobian[12 * r + 6 * side]);
        Eigen::Map<Vector6> response(&response_[12 * r + 6 * side]);
        response.noalias() = inverse_mass[body] * jacobian;
        diagonal_[r] += jacobian.dot(response);
      }
  }

  void start_warm() {
    for (int r = 0; r < problem_.row_count(); ++r)
      change_impulse(r, clamp_impulse(r, problem_.warm_impulse[r]));
  }

  void sweep() {
    for (int r = 0; r < problem_.row_count(); ++r) {
      if (diagonal_[r] <= 0) continue;  // a row that moves nothing
      change_impulse(r, clamp_impulse(r, impulse_[r] - slack(r) / diagonal_[r]));
    }
  }

  std::span<const double> impulse() const { return impulse_; }

 private:
  double slack(int row) const {
    double w = problem_.compliance[row] * impulse_[row] - problem_.rhs[row];
    for (int side = 0; side < 2; ++side) {
      const int body = problem_.row_body[2 * row + side];
      if (body < 0) continue;
      const double* jacobian = &problem_.jacobian[12 * row + 6 * side];
      const double* velocity = &velocity_[6 * body];
      for (int k = 0; k < 6; ++k) w += jacobian[k] * velocity[k];
    }
    return w;
  }

  double clamp_impulse(int row, double impulse) const {
    if (!follows_normal(problem_, row)) return std::clamp(impulse, problem_.lower[row], problem_.upper[row]);
    const double bound = coulomb_bound(problem_, row, impulse_);
    return std::clamp(impulse, -bound, bound);
  }

  void change_impulse(int row, double impulse) {
    const double change = impulse - impulse_[row];
    impulse_[row] = impulse;
    for (int side = 0; side < 2; ++side) {
      const int body = problem_.row_body[2 * row + side];
      if (body < 0) continue;
      const double* response = &response_[12 * row + 6 * side];
      double* velocity = &velocity_[6 * body];
      for (int k = 0; k < 6; ++k) velocity[k] += response[k] * change;
    }
  }

  const StepProblem& problem_;
  std::vector<double> velocity_;  // (n, 6)
  std::vector<double> impulse_;   // (m)
  std::vector<double> response_;  // (m, 12) M^-1 J^T
  std::vector<double> diagonal_;  // (m) of J M^-1 J^T + C
};

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
  BoundPredictor predictor(problem);
  predictor.start_warm();
  for (int s = 0; s < kPredictionSweeps; ++s) predictor.sweep();
  set_coulomb_bounds(predictor.impulse(), problem);
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

ConvergedBounds converge_friction_bounds(StepProblem& problem, StepSolver& solver,
                                         std::span<const int> part_of_body, Solution& solution) {
  ConvergedBounds result;
  while (true) {
    result.last_summary = solver.solve(problem, part_of_body, solution);
    ++result.solves;
    result.mismatch = bound_mismatch(problem, solution.impulse);
    if (result.last_summary.status != SolveStatus::ok) return result;
    result.converged = result.mismatch <= kBoundTolerance;
    if (result.converged || result.solves == kBoundIterationCap) return result;
    set_coulomb_bounds(solution.impulse, problem);
  }
}

}  // namespace cleave
