// Entries of a sparse matrix, in any order and with several at one place, as matrices of other formats are
// put together.
#pragma once

#include <vector>

#include "solver/step_problem.h"

namespace cleave {

struct MatrixEntry {
  int row, column;
  double value;
};

// By columns, then rows; entries at one place are summed in the order in which they came, and sums of 0 left
// out.
void sum_entries(std::vector<MatrixEntry>& entries);

// The at most twelve entries of a row of J, in row `row` and in columns 6 body + k.
std::vector<MatrixEntry> jacobian_entries(const StepProblem& problem, int row);

}  // namespace cleave
