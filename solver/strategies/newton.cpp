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
#include <functional>
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
      if (finish(state)) return true;
      if (!direction(state)) return false;
      const double step = line_search(state);
      state.tasks.run_over(state.step->body_chunks(), [&](const Chunk& chunk) {
        for (int c = 6 * chunk.first; c < 6 * chunk.last; ++c) state.velocity[c] += step * state.dv[c];
      });
    }
    return false;
  }

 private:
  // lambda(v) and the state of every row.
  void read_impulses(SolveState& state) {
    const StepProblem& problem = state.step->problem();
    state.step->jacobian_times(state.velocity, row_velocity_);
    state.run_over_rows([&](int first, int last, int) {
      for (int r = first; r < last; ++r) {
        const double free = (problem.rhs[r] - row_velocity_[r]) / problem.compliance[r];
        state.impulse[r] = std::clamp(free, problem.lower[r], problem.upper[r]);
      }
    });
    state.states_from_impulses();
  }

  // States that stay are tried; where they are not those of the answer, the search goes on from where it was.
  bool finish(SolveState& state) {
    if (state.row_state != last_state_) {
      last_state_ = state.row_state;
      return false;
    }
    kept_velocity_ = state.velocity;
    if (solve_on_states(state)) return true;
    state.velocity = kept_velocity_;
    read_impulses(state);
    return false;
  }

  // Whether an exact solve on the present states violates nothing.
  static bool solve_on_states(SolveState& state) {
    const double tolerance = state.violation_tolerance();
    if (!state.factor_free()) return false;
    state.refine_free(0.1 * tolerance, kMostRefinements, SolveState::Refining::answer);
    return state.find_violations(tolerance) == 0 && state.residual() <= state.step->exact_limit_m_per_s();
  }

  // Newton direction dv from the gradient at v.
  bool direction(SolveState& state) {
    const StepProblem& problem = state.step->problem();
    const auto weigh = [&](int first, int last, int) {
      for (int r = first; r < last; ++r) {
        state.weight[r] = state.row_state[r] == RowState::free ? 1 / problem.compliance[r] : 0.0;
      }
    };
    if (!state.factor(std::cref(weigh))) return false;
    std::fill(state.f_r.begin(), state.f_r.end(), 0.0);
    state.tasks.run_over(state.step->body_chunks(), [&](const Chunk& chunk) {
      for (int body = chunk.first; body < chunk.last; ++body) find_momentum(state, body);
    });
    state.step->add_jacobian_transpose(state.impulse, state.f_v);
    state.solve();
    return true;
  }

  // M (v0 - v) of a body, into f_v.
  static void find_momentum(SolveState& state, int body) {
    const StepProblem& problem = state.step->problem();
    const double* mass = problem.mass.data() + 36L * body;
    for (int row = 0; row < 6; ++row) {
      double sum = 0;
      for (int c = 0; c < 6; ++c) {
        sum += mass[6 * row + c] * (problem.free_velocity[6L * body + c] - state.velocity[6L * body + c]);
      }
      state.f_v[6L * body + row] = sum;
    }
  }

  // The step at which the slope of the energy along dv is zero: slope(t) = slope + t rate, where every row
  // enters with its present piece and changes the rate at its breakpoints. Most of these lie beyond the zero,
  // and are never put in order.
  double line_search(SolveState& state) {
    state.step->jacobian_times(state.dv, row_step_);
    breakpoints_of_chunk_.resize(state.chunk_count());
    state.run_over_rows([&](int first, int last, int chunk) {
      list_breakpoints(state.step->problem(), first, last, breakpoints_of_chunk_[chunk]);
    });
    breakpoints_.clear();
    for (const std::vector<Breakpoint>& found : breakpoints_of_chunk_)
      breakpoints_.insert(breakpoints_.end(), found.begin(), found.end());
    return find_zero(slope_at_start(state));
  }

  struct Slope {
    double slope = 0, rate = 0;
  };
  using Breakpoint = std::pair<double, double>;  // t, change of the rate

  Slope slope_at_start(const SolveState& state) const {
    const StepProblem& problem = state.step->problem();
    Slope sum;
    for (std::size_t i = 0; i < state.dv.size() / 6; ++i) {
      for (int k = 0; k < 36; ++k) {
        const double left = state.dv[6 * i + k / 6] * problem.mass[36 * i + k];
        sum.slope += left * (state.velocity[6 * i + k % 6] - problem.free_velocity[6 * i + k % 6]);
        sum.rate += left * state.dv[6 * i + k % 6];
      }
    }
    for (std::size_t r = 0; r < state.impulse.size(); ++r) {
      sum.slope -= row_step_[r] * state.impulse[r];
      if (state.row_state[r] == RowState::free) sum.rate += curvature(problem, static_cast<int>(r));
    }
    return sum;
  }

  double curvature(const StepProblem& problem, int row) const {
    return row_step_[row] * row_step_[row] / problem.compliance[row];
  }

  void list_breakpoints(const StepProblem& problem, int first, int last,
                        std::vector<Breakpoint>& found) const {
    found.clear();
    for (int r = first; r < last; ++r) {
      const double c = problem.compliance[r], dw = row_step_[r];
      if (dw == 0 || problem.lower[r] == problem.upper[r]) continue;
      const double at_lower = (problem.rhs[r] - row_velocity_[r] - c * problem.lower[r]) / dw;
      const double at_upper = (problem.rhs[r] - row_velocity_[r] - c * problem.upper[r]) / dw;
      const double enter = std::min(at_lower, at_upper), leave = std::max(at_lower, at_upper);
      if (enter > 0 && std::isfinite(enter)) found.emplace_back(enter, curvature(problem, r));
      if (leave > 0 && std::isfinite(leave)) found.emplace_back(leave, -curvature(problem, r));
    }
  }

  double find_zero(Slope at) {
    std::ranges::make_heap(breakpoints_, std::greater{});
    double t = 0;
    while (!breakpoints_.empty()) {
      const auto [next, change] = breakpoints_.front();
      const double slope = at.slope + at.rate * (next - t);
      if (slope >= 0) break;
      at = {slope, at.rate + change};
      t = next;
      std::ranges::pop_heap(breakpoints_, std::greater{});
      breakpoints_.pop_back();
    }
    return at.rate > 0 ? t - at.slope / at.rate : t;
  }

  std::vector<double> row_velocity_, row_step_, kept_velocity_;
  std::vector<std::vector<Breakpoint>> breakpoints_of_chunk_;
  std::vector<Breakpoint> breakpoints_;  // a heap, the least t first
  std::vector<RowState> last_state_;
};

}  // namespace

std::unique_ptr<Strategy> make_newton(const Settings&) { return std::make_unique<Newton>(); }

}  // namespace cleave
