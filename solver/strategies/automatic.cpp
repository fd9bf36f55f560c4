#include "solver/strategies/automatic.h"

#include <algorithm>

namespace cleave {
namespace {

// Block pivoting rarely cycles above this ratio and rarely ends below it on redundant contact.
constexpr double kPivotCompliance = 1e-3;

}  // namespace

StrategyChoice choose_strategies(std::string_view strategy, const PreparedStep& step) {
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
  return {{"interior-point", "newton", "pivot"}, 3, "stiff"};
}

}  // namespace cleave
