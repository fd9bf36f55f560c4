#include "solver/strategies/automatic.h"

#include <algorithm>

namespace cleave {
namespace {

// Block pivoting rarely cycles above this ratio and rarely ends below it on redundant contact.
constexpr double kPivotCompliance = 1e-3;
// Below it pivoting is fast all the same where impulses of the step before leave no more than this residual,
// in units of the velocity scale. Over steps of chains, a tower and piles (cfm 1e-5 to 1e-8) pivot took 0.3
// to 0.8 of the interior point's time up to it (as long where one factorisation was enough for both), and
// above it, handing over most steps, 1.0 to 1.4.
constexpr double kWarmResidual = 0.03;

}  // namespace

StrategyChoice choose_strategies(std::string_view strategy, SolveState& state) {
  const PreparedStep& step = *state.step;
  if (strategy == "pivot") return {{"pivot", "interior-point"}, 2, "-"};
  if (strategy != "auto") return {{strategy}, 1, "-"};
  if (!step.set().cones().empty()) return {{"interior-point"}, 1, "cone"};
  if (!step.set().axes().empty()) return {{"interior-point"}, 1, "turned-box"};
  const StepProblem& problem = step.problem();
  if (std::ranges::all_of(problem.row_kind, [](RowKind kind) { return kind == RowKind::bilateral; })) {
    return {{"pivot", "interior-point"}, 2, "bilateral-only"};
  }
  if (step.least_relative_compliance() >= kPivotCompliance)
    return {{"pivot", "interior-point"}, 2, "compliant"};
  if (state.residual() <= kWarmResidual * step.velocity_scale())
    return {{"pivot", "interior-point", "newton"}, 3, "warm"};
  return {{"interior-point", "newton", "pivot"}, 3, "stiff"};
}

}  // namespace cleave
