// A step problem of some of the rows of another, with all its bodies.
#pragma once

#include <span>
#include <vector>

#include "solver/step_problem.h"

namespace cleave {

// is_kept: (m). Of a contact whose normal row goes the friction rows have to go too. new_row: (m) a row's
// number in `reduced`, -1 of those that went. Allocates nothing where `reduced` and new_row have held as much
// before.
void copy_rows(const StepProblem& problem, std::span<const char> is_kept, StepProblem& reduced,
               std::vector<int>& new_row);

// Values of the rows that are kept, `width` a row; none where there are none.
template <class Value>
void keep_rows(const std::vector<Value>& values, std::span<const char> is_kept, std::vector<Value>& kept,
               std::size_t width = 1) {
  kept.clear();
  if (values.empty()) return;
  for (std::size_t row = 0; row < is_kept.size(); ++row)
    if (is_kept[row] != 0)
      kept.insert(kept.end(), values.begin() + row * width, values.begin() + (row + 1) * width);
}

}  // namespace cleave
