// Which strategies a solve runs, in order: the chain of a named strategy, or what `auto` picks from what it
// sees.
//
//   pivot           pivot, then interior-point when the violations stop falling
//   auto            a cone or a turned box: interior-point, the only one that takes them; all rows bilateral:
//                   pivot (its first factorisation is the answer); otherwise by the scaled compliance C_r /
//                   d_r, which bounds how nearly redundant rows may become dependent: pivot above
//                   kPivotCompliance; below it interior-point, with newton and pivot as nets, unless the
//                   present impulses are nearly right: then pivot, with the others as nets
//   anything else   itself alone
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "solver/solve_state.h"

namespace cleave {

struct StrategyChoice {
  std::array<std::string_view, 3> names{};
  int count = 0;
  std::string reason = "-";  // filled by auto
};

// state: begun, with the impulses that the first strategy starts from.
StrategyChoice choose_strategies(std::string_view strategy, SolveState& state);

}  // namespace cleave
