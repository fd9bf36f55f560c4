// Strategy `interior-point`: Mehrotra predictor-corrector on the box-constrained quadratic programme in
// lambda
//
//     min 1/2 lambda^T (J M^-1 J^T + C) lambda - (b - J v0)^T lambda,   lo <= lambda <= hi
//
// with slacks s_lo = lambda - lo, s_hi = hi - lambda kept as variables (recomputing them loses all digits
// near a bound) and multipliers z_lo, z_hi > 0:   J v + C lambda - b - z_lo + z_hi = 0,   s z = mu.
// Eliminating slacks and multipliers leaves the kernel's system with D_r = 1 / (C_r + z_lo/s_lo + z_hi/s_hi):
// one factorisation and two solves per iteration. Rows with lo = hi are fixed, unbounded rows have no barrier
// term. Steps are scale-free: rows are compared with constants only after scaling by d_r (impulse times d_r
// is a velocity). Source: Mehrotra, "On the implementation of a primal-dual interior point method", SIAM J.
// Optim. 2, 1992; Nocedal and Wright, Numerical Optimization, section 16.6.
//
// Once the duality measure is small the active set can be read off (s against z); an exact solve on that set
// then ends the iteration with the accuracy of a pivoting method. Where the set is not yet right, the
// iteration goes on.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/proximal_step.h"
#include "solver/strategies/strategy.h"

namespace cleave {
namespace {

constexpr double kStepFraction = 0.995;  // of the way to the nearest bound
// Rows whose bounds are closer than this, in m/s or in roundings of the bounds, are fixed between them.
constexpr double kFixedWidth = 1e-13, kFixedRoundings = 64 * std::numeric_limits<double>::epsilon();
constexpr double kCompliant = 1e-4;  // of d_r: from here on the active set can be read off early
constexpr double kWarmShare = 0.1;   // warm impulses are used below this share of the residual without any
constexpr int kMostIterations = 100;
// Below this step, or where the products would grow, Mehrotra's direction is dropped and the products are
// aimed at kCentring of their mean, to first order.
constexpr double kShortStep = 0.1, kCentring = 0.3;

class InteriorPoint : public Strategy {
 public:
  bool run(SolveState& state) override;

 private:
  void start(SolveState& state);
  void choose_impulses(SolveState& state);
  void choose_start(SolveState& state, int row, double speed);
  bool factor(SolveState& state);
  enum class Direction { predictor, corrector, centring };
  void solve(SolveState& state, Direction direction);
  double largest_step(const SolveState& state) const;
  bool is_poor(const SolveState& state) const;
  double measure(double step) const;  // mean of s z after a step along the present direction
  void advance(SolveState& state, double step);
  bool polish(SolveState& state);

  struct Row {
    bool fixed = false, has_lower = false, has_upper = false;
    double s_lo = 0, s_hi = 0, z_lo = 0, z_hi = 0;      // variables
    double ds_lo = 0, ds_hi = 0, dz_lo = 0, dz_hi = 0;  // direction
    double c_lo = 0, c_hi = 0;                          // right-hand sides of the complementarity equations
  };
  std::vector<Row> rows_;
  std::vector<double> kept_impulse_;
  int pairs_ = 0;
};

void InteriorPoint::choose_start(SolveState& state, int r, double speed) {
  const StepProblem& problem = state.step->problem();
  Row& row = rows_[r];
  row = Row{};
  const double d = state.step->diagonal()[r], w = state.slack[r];
  const double width = problem.upper[r] - problem.lower[r];
  row.fixed = d * width <= kFixedWidth ||
              (std::isfinite(width) && width <= kFixedRoundings * std::abs(problem.lower[r]));
  if (row.fixed) return;
  row.has_lower = std::isfinite(problem.lower[r]);
  row.has_upper = std::isfinite(problem.upper[r]);
  // The impulse itself moves inside, so that slacks start feasible even where the bounds are close together.
  const double margin = std::min(speed / d, 0.25 * width);
  if (row.has_lower) state.impulse[r] = std::max(state.impulse[r], problem.lower[r] + margin);
  if (row.has_upper) state.impulse[r] = std::min(state.impulse[r], problem.upper[r] - margin);
  if (row.has_lower) {
    row.s_lo = state.impulse[r] - problem.lower[r];
    row.z_lo = std::max(w, 0.0) + speed;
  }
  if (row.has_upper) {
    row.s_hi = problem.upper[r] - state.impulse[r];
    row.z_hi = std::max(-w, 0.0) + speed;
  }
  pairs_ += row.has_lower + row.has_upper;
}

// Impulses of the last step that are not nearly right lie close to the wrong bounds, which costs more
// iterations than starting from none.
void InteriorPoint::choose_impulses(SolveState& state) {
  const double warm = state.residual();
  kept_impulse_ = state.impulse;
  for (std::size_t r = 0; r < state.impulse.size(); ++r) {
    state.impulse[r] = std::clamp(0.0, state.step->problem().lower[r], state.step->problem().upper[r]);
  }
  state.update_velocity();
  if (kWarmShare * state.residual() < warm) return;
  state.impulse = kept_impulse_;
  state.update_velocity();
}

// Slacks and multipliers at the present impulses, pushed into the interior by a typical speed of the step.
void InteriorPoint::start(SolveState& state) {
  const StepProblem& problem = state.step->problem();
  const int m = problem.row_count();
  choose_impulses(state);
  rows_.resize(m);
  pairs_ = 0;
  double sum = 0, largest = 0;
  for (int r = 0; r < m; ++r) {
    sum += state.slack[r] * state.slack[r];
    largest = std::max(largest, std::abs(state.slack[r]));
  }
  // A warm start may be right in all rows but a few: those must not start far off the central path.
  const double speed = std::max({1e-3, m > 0 ? std::sqrt(sum / m) : 0.0, 0.1 * largest});
  for (int r = 0; r < m; ++r) {
    choose_start(state, r, speed);
    if (rows_[r].fixed) state.impulse[r] = 0.5 * (problem.lower[r] + problem.upper[r]);
  }
  state.update_velocity();
}

bool InteriorPoint::factor(SolveState& state) {
  const StepProblem& problem = state.step->problem();
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const Row& row = rows_[r];
    double barrier = 0;
    if (row.has_lower) barrier += row.z_lo / row.s_lo;
    if (row.has_upper) barrier += row.z_hi / row.s_hi;
    state.weight[r] = row.fixed ? 0.0 : 1 / (problem.compliance[r] + barrier);
  }
  ++state.summary->factorizations;
  return state.kernel->factor(state.weight, state.tasks);
}

void InteriorPoint::solve(SolveState& state, Direction direction) {
  const bool corrector = direction == Direction::corrector;
  const StepProblem& problem = state.step->problem();
  double target = direction == Direction::centring ? kCentring * measure(0) : 0.0;
  if (corrector) {
    const double now = measure(0), affine = measure(largest_step(state));
    const double ratio = affine / now;
    target = ratio * ratio * ratio * now;
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    Row& row = rows_[r];
    state.f_r[r] = 0;
    if (row.fixed) continue;
    double f = -state.slack[r];
    if (row.has_lower) {
      row.c_lo = target - row.s_lo * row.z_lo - (corrector ? row.ds_lo * row.dz_lo : 0.0);
      f += row.z_lo + (row.c_lo - row.z_lo * (state.impulse[r] - problem.lower[r] - row.s_lo)) / row.s_lo;
    }
    if (row.has_upper) {
      row.c_hi = target - row.s_hi * row.z_hi - (corrector ? row.ds_hi * row.dz_hi : 0.0);
      f -= row.z_hi + (row.c_hi - row.z_hi * (problem.upper[r] - state.impulse[r] - row.s_hi)) / row.s_hi;
    }
    state.f_r[r] = f;
  }
  std::fill(state.f_v.begin(), state.f_v.end(), 0.0);
  state.kernel->solve(state.f_v, state.f_r, state.dv, state.dlambda, state.tasks);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    Row& row = rows_[r];
    if (row.has_lower) {
      row.ds_lo = state.dlambda[r] + (state.impulse[r] - problem.lower[r] - row.s_lo);
      row.dz_lo = (row.c_lo - row.z_lo * row.ds_lo) / row.s_lo;
    }
    if (row.has_upper) {
      row.ds_hi = -state.dlambda[r] + (problem.upper[r] - state.impulse[r] - row.s_hi);
      row.dz_hi = (row.c_hi - row.z_hi * row.ds_hi) / row.s_hi;
    }
  }
}

double InteriorPoint::largest_step(const SolveState&) const {
  double step = 1;
  const auto limit = [&](double value, double change) {
    if (change < 0) step = std::min(step, -value / change);
  };
  for (const Row& row : rows_) {
    if (row.has_lower) limit(row.s_lo, row.ds_lo), limit(row.z_lo, row.dz_lo);
    if (row.has_upper) limit(row.s_hi, row.ds_hi), limit(row.z_hi, row.dz_hi);
  }
  return step;
}

double InteriorPoint::measure(double step) const {
  double sum = 0;
  for (const Row& row : rows_) {
    if (row.has_lower) sum += (row.s_lo + step * row.ds_lo) * (row.z_lo + step * row.dz_lo);
    if (row.has_upper) sum += (row.s_hi + step * row.ds_hi) * (row.z_hi + step * row.dz_hi);
  }
  return pairs_ > 0 ? sum / pairs_ : 0.0;
}

void InteriorPoint::advance(SolveState& state, double step) {
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    Row& row = rows_[r];
    if (row.fixed) continue;
    state.impulse[r] += step * state.dlambda[r];
    row.s_lo += step * row.ds_lo;
    row.s_hi += step * row.ds_hi;
    row.z_lo += step * row.dz_lo;
    row.z_hi += step * row.dz_hi;
  }
  state.update_velocity();
}

// Mehrotra's second-order term is right for a full step only. Where bounds cut the step it can throw products
// s z far off the central path, and the iteration then cycles (Cartis, "Some disadvantages of a Mehrotra-type
// primal-dual corrector interior point algorithm for linear programming", Appl. Numer. Math. 59, 2009).
bool InteriorPoint::is_poor(const SolveState& state) const {
  const double step = largest_step(state);
  return step < kShortStep || measure(kStepFraction * step) > measure(0);
}

// Reads the active set off the slacks and multipliers and solves on it exactly, flipping what is still wrong
// a few times. On failure the interior iterate is restored.
bool InteriorPoint::polish(SolveState& state) {
  const double tolerance = 0.1 * state.options.target_m_per_s * state.step->velocity_scale();
  kept_impulse_ = state.impulse;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const Row& row = rows_[r];
    const double d = state.step->diagonal()[r];
    state.state[r] = RowState::free;
    if (row.fixed || (row.has_lower && d * row.s_lo < row.z_lo)) state.state[r] = RowState::lower;
    if (row.has_upper && d * row.s_hi < row.z_hi) state.state[r] = RowState::upper;
  }
  if (state.settle(tolerance) && state.residual() <= exact_limit_m_per_s(*state.step)) return true;
  state.impulse = kept_impulse_;
  state.update_velocity();
  return false;
}

bool InteriorPoint::run(SolveState& state) {
  start(state);
  const bool compliant = least_relative_compliance(*state.step) >= kCompliant;
  double polish_below = (compliant ? 1e-5 : 1e-6) * state.step->velocity_scale();
  for (int k = 0; k < kMostIterations; ++k) {
    double worst = 0;  // largest complementarity product and residual as velocities
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const Row& row = rows_[r];
      const double d = state.step->diagonal()[r];
      if (row.has_lower) worst = std::max(worst, std::min(d * row.s_lo, row.z_lo));
      if (row.has_upper) worst = std::max(worst, std::min(d * row.s_hi, row.z_hi));
      if (!row.fixed) worst = std::max(worst, std::abs(state.slack[r] - row.z_lo + row.z_hi));
    }
    if (worst <= polish_below) {
      if (polish(state)) return true;
      if (worst <= state.options.target_m_per_s) return state.residual() <= exact_limit_m_per_s(*state.step);
      polish_below = 1e-2 * worst;
    }
    ++state.summary->iterations;
    if (!factor(state)) return false;
    solve(state, Direction::predictor);
    solve(state, Direction::corrector);
    if (is_poor(state)) solve(state, Direction::centring);
    advance(state, std::min(1.0, kStepFraction * largest_step(state)));
  }
  return state.residual() <= exact_limit_m_per_s(*state.step);
}

}  // namespace

std::unique_ptr<Strategy> make_interior_point() { return std::make_unique<InteriorPoint>(); }

}  // namespace cleave
