// Strategy `newton`: semi-smooth Newton on the velocity, with exact line search.
//
// With lambda(v) = clamp((b - J v) / C, lo, hi) the step problem is the unconstrained minimisation of the
// convex, piecewise-quadratic energy
//
//     phi(v) = 1/2 (v - v0)^T M (v - v0) + sum_r psi_r(J_r v),   psi_r' = -lambda_r
//
// whose gradient is M (v - v0) - J^T lambda(v) and whose generalised Hessian is M + J_F^T C^-1 J_F over the
// free rows F. Along a direction p the slope is piecewise linear in the step, so its zero is found exactly by
// sorting the breakpoints where a row meets a bound. The energy falls in every iteration, so it cannot cycle;
// at low compliance it becomes slow. Source: Qi and Sun 1993; Todorov, "Convex and analytically-invertible
// dynamics with contacts", 2014.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "solver/gauss_seidel.h"
#include "solver/strategies/strategy.h"

namespace cleave {
namespace {

constexpr double kLeastCompliance = 1e-15;  // of d_r
constexpr int kPredictorSweeps = 5;
constexpr int kMostRefinements = 8;  // of the exact solve at the end

class Newton : public Strategy {
 public:
  bool run(SolveState& state) override {
    if (state.step->least_relative_compliance() < kLeastCompliance) return false;  // lambda(v) divides by it
    {
      StageTimer timer(state.tasks.clock(), Stage::predict);
      gauss_seidel_sweeps(*state.step, kPredictorSweeps, state.impulse, state.velocity, state.options.stop);
    }
    const std::size_t m = state.impulse.size();
    row_velocity_.resize(m);
    row_step_.resize(m);
    last_state_.clear();
    for (int k = 0; k < state.options.max_iterations; ++k) {
      ++state.summary->iterations;
      read_impulses(state);
      kept_velocity_ = state.velocity;
      if (finish(state)) return true;
      state.velocity = kept_velocity_;
      read_impulses(state);
      if (!direction(state)) return false;
      const double step = line_search(state);
      for (std::size_t c = 0; c < state.velocity.size(); ++c) state.velocity[c] += step * state.dv[c];
    }
    return false;
  }

 private:
  // lambda(v) and the state of every row.
  void read_impulses(SolveState& state) {
    const StepProblem& problem = state.step->problem();
    state.step->jacobian_times(state.velocity, row_velocity_);
    for (std::size_t r = 0; r < state.impulse.size(); ++r) {
      const double free = (problem.rhs[r] - row_velocity_[r]) / problem.compliance[r];
      state.impulse[r] = std::clamp(free, problem.lower[r], problem.upper[r]);
    }
    state.states_from_impulses();
  }

  // An exact solve on the present states ends the search when it violates nothing.
  bool finish(SolveState& state) {
    const double tolerance = state.violation_tolerance();
    if (state.row_state == last_state_) {
      if (!state.factor_free()) return false;
      state.refine_free(0.1 * tolerance, kMostRefinements, true);
      if (state.find_violations(tolerance) == 0) return state.residual() <= state.step->exact_limit_m_per_s();
    }
    last_state_ = state.row_state;
    return false;
  }

  // Newton direction dv from the gradient at v.
  bool direction(SolveState& state) {
    const StepProblem& problem = state.step->problem();
    for (std::size_t r = 0; r < state.impulse.size(); ++r) {
      state.weight[r] = state.row_state[r] == RowState::free ? 1 / problem.compliance[r] : 0.0;
    }
    if (!state.factor()) return false;
    std::fill(state.f_r.begin(), state.f_r.end(), 0.0);
    for (std::size_t i = 0; i < state.velocity.size() / 6; ++i) {
      for (int row = 0; row < 6; ++row) {
        double sum = 0;
        for (int c = 0; c < 6; ++c) {
          sum += problem.mass[36 * i + 6 * row + c] *
                 (problem.free_velocity[6 * i + c] - state.velocity[6 * i + c]);
        }
        state.f_v[6 * i + row] = sum;
      }
    }
    state.step->add_jacobian_transpose(state.impulse, state.f_v);
    state.solve();
    return true;
  }

  // The step at which the slope of the energy along dv is zero.
  double line_search(SolveState& state) {
    const StepProblem& problem = state.step->problem();
    state.step->jacobian_times(state.dv, row_step_);
    // slope(t) = constant + t * rate; rows enter with their present piece and change it at their breakpoints.
    double constant = 0, rate = 0;
    for (std::size_t i = 0; i < state.dv.size() / 6; ++i) {
      for (int k = 0; k < 36; ++k) {
        const double left = state.dv[6 * i + k / 6] * problem.mass[36 * i + k];
        constant += left * (state.velocity[6 * i + k % 6] - problem.free_velocity[6 * i + k % 6]);
        rate += left * state.dv[6 * i + k % 6];
      }
    }
    breakpoints_.clear();
    for (std::size_t r = 0; r < state.impulse.size(); ++r) {
      const double c = problem.compliance[r], dw = row_step_[r];
      constant -= dw * state.impulse[r];
      const double curvature = dw * dw / c;
      if (state.row_state[r] == RowState::free) rate += curvature;
      if (dw == 0 || problem.lower[r] == problem.upper[r]) continue;
      const double at_lower = (problem.rhs[r] - row_velocity_[r] - c * problem.lower[r]) / dw;
      const double at_upper = (problem.rhs[r] - row_velocity_[r] - c * problem.upper[r]) / dw;
      const double enter = std::min(at_lower, at_upper), leave = std::max(at_lower, at_upper);
      if (enter > 0 && std::isfinite(enter)) breakpoints_.emplace_back(enter, curvature);
      if (leave > 0 && std::isfinite(leave)) breakpoints_.emplace_back(leave, -curvature);
    }
    std::sort(breakpoints_.begin(), breakpoints_.end());
    double t = 0, slope = constant;
    for (const auto& [at, change] : breakpoints_) {
      const double next = slope + rate * (at - t);
      if (next >= 0) break;
      slope = next;
      t = at;
      rate += change;
    }
    return rate > 0 ? t - slope / rate : t;
  }

  std::vector<double> row_velocity_, row_step_, kept_velocity_;
  std::vector<std::pair<double, double>> breakpoints_;  // (step, change of the slope's rate)
  std::vector<RowState> last_state_;
};

}  // namespace

std::unique_ptr<Strategy> make_newton(const Settings&) { return std::make_unique<Newton>(); }

}  // namespace cleave
