// Column largest_impulse_n_s: the largest impulse of a solution, N s (N m s for angular rows).
#include <algorithm>
#include <cmath>

#include "harness/experiment/cell_measures.h"

namespace cleave {

double largest_impulse_n_s(const Cell& cell) {
  double largest = 0;
  for (const double impulse : cell.solution.impulse) largest = std::max(largest, std::abs(impulse));
  return largest;
}

}  // namespace cleave
