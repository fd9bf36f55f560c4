#include "harness/experiment/cell_measures.h"

#include "harness/experiment/part_condition.h"

namespace cleave {

std::span<const CellMeasure> cell_measures() {
  static constexpr CellMeasure table[] = {
      {"part_condition_max",
       "largest condition number of a part's matrix with all its interior rows free, 1-norm, SI units",
       largest_part_condition},
  };
  return table;
}

}  // namespace cleave
