// Strategy `interior-point`: Mehrotra's predictor-corrector on the box-constrained quadratic programme of the
// step, with Gondzio's centrality corrections (equations in interior_iterate.h). One factorisation an
// iteration and two back-substitutions; a third where Mehrotra's direction is poor, and up to two corrections
// (with cones one) where bounds cut the step short. On 200 rocks a back-substitution costs a fifth of
// assembly and factorisation, on more of them less; the corrections save a sixth of the iterations.
//
// Once the error is small an exact solve ends the iteration (interior_end.h). Where that finds no answer yet,
// the iteration goes on, and where rounding keeps it from ever finding one, the best interior iterate is the
// answer if it is within the limit.
//
// Cones of very different masses, or of a large mu, may stop the first steps short and leave products that no
// direction brings back to the centre. Such an iteration begins anew, further inside and with shorter steps.
// So does one between bounds that ends without an answer: from impulses that are nearly right, full steps may
// make the error grow for a while, which cannot be told from rounding.
//
// Under Coulomb's law every direction is that of the law (coulomb_shift.h). The problem is then not convex,
// and the iteration may stall where the exact solve does not: that is tried before the first iteration, from
// the impulses of the step before, and again where iterations make no progress. Where all of it fails, status
// and residual say so.
#include <algorithm>
#include <limits>
#include <utility>

#include "solver/strategies/interior_constants.h"
#include "solver/strategies/interior_end.h"
#include "solver/strategies/interior_iterate.h"
#include "solver/strategies/strategy.h"

namespace cleave {
namespace {

// Of the change of Coulomb's shift in a direction: how exact, in units of the error that the direction is to
// remove, and the most back-substitutions for it.
constexpr double kShiftAccuracy = 0.1;
constexpr int kMostShifts = 8;

// Further attempts at the end under Coulomb's law: at this share of the error of the one before; where the
// error has not fallen to this share in so many iterations, and again where it is this share of the last
// attempt's. After so many the iteration ends. Of 300 piles of 18 boxes with cfm 1e-5 to 1e-7 236 are solved
// so; where only iterations that lower the error not at all were counted, 216 were, with a sixth more
// factorisations, since an error may also creep.
constexpr double kNextLawPolish = 0.1;
constexpr double kLawProgress = 0.5;
constexpr int kStalledIterations = 5, kHopelessIterations = 40;

// With cones: so many steps in a row below this length, and the iteration begins anew. It does so, as where
// it ended without an answer, with products of so many times the energy and this share of the way to the
// boundary. Two to four boxes with masses in ratios of 1e5 and 1e6 that spin are solved in some 30 iterations
// then and were not in 100. Of 240 random problems (mu up to 1000, compliances down to 0) 191 are solved and
// were 177, all of those among them; after 5 short steps two of these were lost, 12 take more factorisations.
constexpr int kMostShortSteps = 8;
constexpr double kShortStep = 0.05;
constexpr double kFurtherInside = 3e4, kCarefulFraction = 0.9;

class InteriorPoint : public Strategy {
 public:
  explicit InteriorPoint(const InteriorConstants& constants)
      : constants_(constants), iterate_(constants), end_(constants) {}
  bool run(SolveState& state) override;
  SetKind takes() const override { return SetKind::cones; }

 private:
  enum class Progress { good, finished, rounding };
  void begin(SolveState& state);
  bool search(SolveState& state);
  bool search_from_further_inside(SolveState& state);
  bool is_lost() const { return has_convex_cones_ && !is_careful_ && short_steps_ >= kMostShortSteps; }
  double step_fraction() const { return is_careful_ ? kCarefulFraction : constants_.step_fraction; }
  Progress watch(const SolveState& state, double error);
  bool is_stalled() const;
  bool is_hopeless() const { return has_coulomb_ && since_progress_ >= kHopelessIterations; }
  bool finish(SolveState& state);
  void step(SolveState& state, double error);
  void adapt_delta(double rounding);
  bool raise_delta();
  bool is_poor() const;

  InteriorConstants constants_;
  InteriorIterate iterate_;
  InteriorEnd end_;
  double last_polish_ = 0;  // the error of the last attempt at the end
  double best_error_ = 0, last_step_ = 1, polish_below_ = 0;
  int since_best_ = 0, grown_ = 0, raises_ = 0;
  double progress_to_ = 0;  // the error that the last progress under Coulomb's law led to
  int since_progress_ = 0;  // iterations
  double delta_ = 0, least_delta_ = 0, best_delta_ = 0;
  bool has_coulomb_ = false, has_convex_cones_ = false;
  bool is_careful_ = false;  // the iteration has begun anew
  int iterations_left_ = 0, short_steps_ = 0;
  // But under Coulomb's law: of the start, and the best before the iteration began anew.
  std::vector<double> warm_impulse_, earlier_impulse_;
  bool is_start_ = true, best_is_start_ = false;  // of cones, whose error is that of the impulses alone
  bool rounds_ = false;                           // there are rows that delta may matter to
};

// Mehrotra's second-order term is right for a full step only. Where bounds cut the step it can throw products
// s z far off the central path, and the iteration then cycles (Cartis, "Some disadvantages of a Mehrotra-type
// primal-dual corrector interior point algorithm for linear programming", Appl. Numer. Math. 59, 2009).
bool InteriorPoint::is_poor() const {
  const double step = iterate_.largest_step();
  return step < constants_.short_step ||
         iterate_.mean_product(step_fraction() * step) > iterate_.mean_product(0);
}

// The compliance delta that is factored follows the rounding of the directions, in units of the error they
// are to remove.
void InteriorPoint::adapt_delta(double rounding) {
  if (rounding > constants_.much_rounding)
    delta_ = std::min(constants_.delta_rise * delta_, constants_.most_delta);
  if (rounding < constants_.little_rounding) delta_ = std::max(constants_.delta_fall * delta_, least_delta_);
}

// False when it was raised often enough.
bool InteriorPoint::raise_delta() {
  if (raises_++ == constants_.raises) return false;
  least_delta_ *= constants_.raise_factor;
  delta_ = std::max(constants_.raise_factor * best_delta_, least_delta_);
  return true;
}

void InteriorPoint::step(SolveState& state, double error) {
  using Aim = InteriorIterate::Aim;
  iterate_.find_direction(state, Aim::affine);
  iterate_.find_direction(state, Aim::mehrotra);
  if (is_poor()) iterate_.find_direction(state, Aim::centre);
  if (has_coulomb_) iterate_.match_shift(state, kShiftAccuracy * error, kMostShifts);
  iterate_.correct_centrality(state);
  if (rounds_) adapt_delta(iterate_.rounding(state) / error);
  last_step_ = std::min(1.0, step_fraction() * iterate_.largest_step());
  short_steps_ = last_step_ < kShortStep ? short_steps_ + 1 : 0;
  iterate_.advance(state, last_step_);
}

// Keeps the best iterate. Finished: within the limit, and no better for a while. Rounding: full steps, but a
// growing error. The error of cones does not see that the start is inside them where the impulses are not:
// impulses of the step before may be better than the first iterates, which are none the worse for it.
InteriorPoint::Progress InteriorPoint::watch(const SolveState& state, double error) {
  const bool is_start = std::exchange(is_start_, false);
  ++since_progress_;
  if (error < kLawProgress * progress_to_) progress_to_ = error, since_progress_ = 0;
  if (error < best_error_) {
    best_error_ = error;
    best_is_start_ = is_start && !state.step->set().cones().empty();
    best_delta_ = delta_;
    since_best_ = grown_ = 0;
    iterate_.keep();
    return Progress::good;
  }
  ++since_best_;
  const bool settled = !best_is_start_ && best_error_ < constants_.settled * state.step->velocity_scale();
  if (settled && last_step_ >= constants_.full_step && error > constants_.growth * best_error_) ++grown_;
  if (best_error_ <= state.step->exact_limit_m_per_s() && since_best_ >= constants_.patience) {
    return Progress::finished;
  }
  return grown_ >= constants_.patience ? Progress::rounding : Progress::good;
}

void InteriorPoint::begin(SolveState& state) {
  const double least = state.step->least_relative_compliance();
  has_coulomb_ = state.step->set().has_coulomb();
  has_convex_cones_ = !has_coulomb_ && !state.step->set().cones().empty();
  end_.begin(state);
  polish_below_ = end_.first_error(state) * state.step->velocity_scale();
  delta_ = constants_.first_delta;
  best_delta_ = delta_;
  least_delta_ = constants_.least_delta;
  rounds_ = least < constants_.most_delta;
  best_error_ = progress_to_ = std::numeric_limits<double>::infinity();
  since_best_ = since_progress_ = grown_ = raises_ = short_steps_ = 0;
  is_start_ = true;
  last_polish_ = std::numeric_limits<double>::infinity();
}

// Under Coulomb's law: no progress for iterations, and since the last attempt at the end so much that another
// may go elsewhere.
bool InteriorPoint::is_stalled() const {
  return has_coulomb_ && since_progress_ >= kStalledIterations && best_error_ <= kLawProgress * last_polish_;
}

bool InteriorPoint::run(SolveState& state) {
  is_careful_ = false;
  iterations_left_ = state.options.max_iterations;
  begin(state);
  if (!has_coulomb_) warm_impulse_ = state.impulse;
  if (has_coulomb_ && end_.attempt(state, iterate_)) return true;
  iterate_.start(state);
  if (search(state) || finish(state)) return true;
  return !has_coulomb_ && iterations_left_ > 0 && search_from_further_inside(state);
}

// Where it finds no answer either, the better impulses of the two stay.
bool InteriorPoint::search_from_further_inside(SolveState& state) {
  const double residual = state.residual();
  earlier_impulse_ = state.impulse;
  state.load(warm_impulse_);
  is_careful_ = true;
  begin(state);
  iterate_.start(state, kFurtherInside);
  if (search(state) || finish(state)) return true;
  if (residual < state.residual()) state.load(earlier_impulse_);
  return false;
}

// True where an attempt at the end has found the answer.
bool InteriorPoint::search(SolveState& state) {
  const double target = state.target_m_per_s();
  for (; iterations_left_ > 0 && !is_lost(); --iterations_left_) {
    double error = iterate_.error();
    const Progress progress = watch(state, error);
    if (progress == Progress::finished || is_hopeless()) break;
    if (progress == Progress::rounding) {
      if (!raise_delta()) break;
      iterate_.restore(state);
      error = best_error_;
      since_best_ = grown_ = 0;
    }
    if (error <= polish_below_) {
      if (end_.attempt(state, iterate_)) return true;
      if (error <= target) break;
      polish_below_ = std::max((has_coulomb_ ? kNextLawPolish : constants_.next_polish) * error, target);
      last_polish_ = error;
    } else if (is_stalled()) {
      if (end_.attempt_from_best(state, iterate_)) return true;
      last_polish_ = best_error_;
    }
    ++state.summary->iterations;
    if (iterate_.factor(state, delta_)) {
      step(state, error);
    } else if (!raise_delta()) {
      break;
    }
  }
  return false;
}

bool InteriorPoint::finish(SolveState& state) {
  iterate_.restore(state);
  return end_.last_resort(state);
}

}  // namespace

std::unique_ptr<Strategy> make_interior_point(const Settings&) {
  return make_interior_point(InteriorConstants{});
}

std::unique_ptr<Strategy> make_interior_point(const InteriorConstants& constants) {
  return std::make_unique<InteriorPoint>(constants);
}

}  // namespace cleave
