#include "solver/strategies/interior_end.h"

namespace cleave {
namespace {

// Attempts under Coulomb's law: below this error, in units of the velocity scale.
constexpr double kFirstLawError = 1e-5;

}  // namespace

void InteriorEnd::begin(const SolveState& state) {
  has_cones_ = !state.step->set().cones().empty();
  has_coulomb_ = state.step->set().has_coulomb();
  if (has_coulomb_) warm_impulse_ = state.impulse;
  least_law_residual_ = std::numeric_limits<double>::infinity();
}

double InteriorEnd::first_error(const SolveState& state) const {
  const double least_compliance = state.step->least_relative_compliance();
  if (has_coulomb_) return kFirstLawError;
  if (has_cones_) return ConeNewton::first_residual(least_compliance);
  return least_compliance >= constants_.soft_compliance    ? constants_.soft_polish
         : least_compliance >= constants_.firm_compliance  ? constants_.firm_polish
         : least_compliance >= constants_.stiff_compliance ? constants_.stiff_polish
                                                           : constants_.rigid_polish;
}

bool InteriorEnd::solve_cones(SolveState& state, double tolerance) {
  const double residual = newton_.run(state, tolerance);
  if (residual <= state.step->exact_limit_m_per_s()) return true;
  if (has_coulomb_ && residual < least_law_residual_) {
    least_law_residual_ = residual;
    law_impulse_ = state.impulse;
  }
  return false;
}

// Flips what is still wrong in the set a few times.
bool InteriorEnd::solve_rows(SolveState& state, const InteriorIterate& iterate, double tolerance) {
  const Settling settling{constants_.polish_rounds, constants_.polish_refinements,
                          constants_.polish_violations, constants_.polish_violated_share};
  iterate.read_active_set(state);
  return state.settle(tolerance, settling) && state.residual() <= state.step->exact_limit_m_per_s();
}

// Under Coulomb's law up to the target itself: digits beyond it are a step that takes a thirteenth of all.
bool InteriorEnd::attempt(SolveState& state, const InteriorIterate& iterate) {
  const double tolerance = (has_coulomb_ ? 1 : constants_.polish_accuracy) * state.target_m_per_s();
  kept_impulse_ = state.impulse;
  if (has_cones_ ? solve_cones(state, tolerance) : solve_rows(state, iterate, tolerance)) return true;
  state.load(kept_impulse_);
  return false;
}

bool InteriorEnd::attempt_from_best(SolveState& state, const InteriorIterate& iterate) {
  present_impulse_ = state.impulse;
  iterate.load_kept_impulses(state);
  if (attempt(state, iterate)) return true;
  state.load(present_impulse_);
  return false;
}

bool InteriorEnd::last_resort(SolveState& state) {
  if (least_law_residual_ < state.residual()) state.load(law_impulse_);
  if (state.residual() <= state.step->exact_limit_m_per_s()) return true;
  return has_coulomb_ && last_.run(state, warm_impulse_);
}

}  // namespace cleave
