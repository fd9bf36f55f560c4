// Strategy `interior-point`: Mehrotra's predictor-corrector on the box-constrained quadratic programme of the
// step, with Gondzio's centrality corrections (equations in interior_iterate.h). One factorisation an
// iteration and two back-substitutions; a third where Mehrotra's direction is poor, and up to two corrections
// where bounds cut the step short. On 200 rocks a back-substitution costs a fifth of assembly and
// factorisation, on more of them less; the corrections save a sixth of the iterations.
//
// Once the error is small the active set can be read off (s against z); an exact solve on that set then ends
// the iteration with the accuracy of a pivoting method. Where the set is not yet right, the iteration goes
// on, and where rounding keeps the set from ever being right, the best interior iterate is the answer if it
// is within the limit.
#include <cmath>
#include <limits>

#include "solver/strategies/interior_iterate.h"
#include "solver/strategies/strategy.h"

namespace cleave {
namespace {

constexpr double kStepFraction = 0.995;  // of the way to the nearest bound
constexpr double kShortStep = 0.1;
// First attempt at the active set, as an error in units of the velocity scale, by least C_r / d_r: stiffer
// rows leave it undecided for longer. A failed attempt is repeated at a hundredth of the error.
struct FirstPolish {
  double compliance, error;
};
constexpr FirstPolish kFirstPolish[] = {{1e-4, 1e-5}, {1e-9, 1e-6}, {1e-11, 1e-8}, {0, 1e-10}};
constexpr double kNextPolish = 1e-2;
// The compliance delta that is factored follows the rounding of the directions, in units of the error they
// are to remove: from kFactoredCompliance tenfold up or down, within these limits.
constexpr double kLeastDelta = 1e-14, kMostDelta = 1e-9;
constexpr double kMuchRounding = 0.1, kLittleRounding = 1e-3;
constexpr int kRaises = 3;         // of the least delta, when full steps make the error grow all the same
constexpr double kSettled = 1e-3;  // errors above this, of the velocity scale, may grow
constexpr double kFullStep = 0.9, kGrowth = 2;
constexpr int kPatience = 2;  // iterations without progress

class InteriorPoint : public Strategy {
 public:
  bool run(SolveState& state) override;

 private:
  enum class Progress { good, finished, rounding };
  void begin(SolveState& state);
  Progress watch(const SolveState& state, double error);
  bool polish(SolveState& state);
  void step(SolveState& state, double error);
  void adapt_delta(double rounding);
  bool raise_delta();
  bool is_poor() const;

  InteriorIterate iterate_;
  std::vector<double> kept_impulse_;
  double best_error_ = 0, last_step_ = 1, polish_below_ = 0;
  int since_best_ = 0, grown_ = 0, raises_ = 0;
  double delta_ = 0, least_delta_ = 0, best_delta_ = 0;
  bool rounds_ = false;  // there are rows that delta may matter to
};

// Mehrotra's second-order term is right for a full step only. Where bounds cut the step it can throw products
// s z far off the central path, and the iteration then cycles (Cartis, "Some disadvantages of a Mehrotra-type
// primal-dual corrector interior point algorithm for linear programming", Appl. Numer. Math. 59, 2009).
bool InteriorPoint::is_poor() const {
  const double step = iterate_.largest_step();
  return step < kShortStep || iterate_.mean_product(kStepFraction * step) > iterate_.mean_product(0);
}

void InteriorPoint::adapt_delta(double rounding) {
  if (rounding > kMuchRounding) delta_ = std::min(10 * delta_, kMostDelta);
  if (rounding < kLittleRounding) delta_ = std::max(0.1 * delta_, least_delta_);
}

// False when it was raised often enough.
bool InteriorPoint::raise_delta() {
  if (raises_++ == kRaises) return false;
  least_delta_ *= 10;
  delta_ = std::max(10 * best_delta_, least_delta_);
  return true;
}

void InteriorPoint::step(SolveState& state, double error) {
  using Aim = InteriorIterate::Aim;
  iterate_.find_direction(state, Aim::affine);
  iterate_.find_direction(state, Aim::mehrotra);
  if (is_poor()) iterate_.find_direction(state, Aim::centre);
  iterate_.correct_centrality(state);
  if (rounds_) adapt_delta(iterate_.rounding(state) / error);
  last_step_ = std::min(1.0, kStepFraction * iterate_.largest_step());
  iterate_.advance(state, last_step_);
}

// Reads the active set off the slacks and multipliers and solves on it exactly, flipping what is still wrong
// a few times. On failure the interior iterate is restored.
bool InteriorPoint::polish(SolveState& state) {
  const double tolerance = 0.1 * state.options.target_m_per_s * state.step->velocity_scale();
  kept_impulse_ = state.impulse;
  iterate_.read_active_set(state);
  if (state.settle(tolerance) && state.residual() <= state.step->exact_limit_m_per_s()) return true;
  state.impulse = kept_impulse_;
  state.update_velocity();
  return false;
}

// Keeps the best iterate. Finished: within the limit, and no better for a while. Rounding: full steps, but a
// growing error.
InteriorPoint::Progress InteriorPoint::watch(const SolveState& state, double error) {
  if (error < best_error_) {
    best_error_ = error;
    best_delta_ = delta_;
    since_best_ = grown_ = 0;
    iterate_.keep(state);
    return Progress::good;
  }
  ++since_best_;
  const bool settled = best_error_ < kSettled * state.step->velocity_scale();
  if (settled && last_step_ >= kFullStep && error > kGrowth * best_error_) ++grown_;
  if (best_error_ <= state.step->exact_limit_m_per_s() && since_best_ >= kPatience) return Progress::finished;
  return grown_ >= kPatience ? Progress::rounding : Progress::good;
}

void InteriorPoint::begin(SolveState& state) {
  const double least = state.step->least_relative_compliance();
  polish_below_ = 0;
  for (const FirstPolish& first : kFirstPolish) {
    if (polish_below_ == 0 && least >= first.compliance) {
      polish_below_ = first.error * state.step->velocity_scale();
    }
  }
  delta_ = kFactoredCompliance;
  best_delta_ = delta_;
  least_delta_ = kLeastDelta;
  rounds_ = least < kMostDelta;
  best_error_ = std::numeric_limits<double>::infinity();
  since_best_ = grown_ = raises_ = 0;
  iterate_.start(state);
}

bool InteriorPoint::run(SolveState& state) {
  begin(state);
  const double target = state.options.target_m_per_s * state.step->velocity_scale();
  for (int k = 0; k < state.options.max_iterations; ++k) {
    double error = iterate_.error(state);
    const Progress progress = watch(state, error);
    if (progress == Progress::finished) break;
    if (progress == Progress::rounding) {
      if (!raise_delta()) break;
      iterate_.restore(state);
      error = best_error_;
      since_best_ = grown_ = 0;
    }
    if (error <= polish_below_) {
      if (polish(state)) return true;
      if (error <= target) break;
      polish_below_ = std::max(kNextPolish * error, target);
    }
    ++state.summary->iterations;
    if (iterate_.factor(state, delta_)) {
      step(state, error);
    } else if (!raise_delta()) {
      break;
    }
  }
  iterate_.restore(state);
  return state.residual() <= state.step->exact_limit_m_per_s();
}

}  // namespace

std::unique_ptr<Strategy> make_interior_point(const Settings&) { return std::make_unique<InteriorPoint>(); }

}  // namespace cleave
