// The Schur complement of a partition over its interface rows, from its definition, as others may want to
// look at it: nothing here is shared with the solvers.
#pragma once

#include <vector>

#include "harness/files/matrix_entries.h"

namespace cleave {

// M + J^T C^-1 J over the given rows: the lower triangle, several entries at a place. Throws
// std::invalid_argument for a row of compliance 0.
std::vector<MatrixEntry> system_entries(const StepProblem& problem, const std::vector<int>& rows);

// Rows whose two bodies are in different parts, in the order of the problem.
std::vector<int> interface_rows(const StepProblem& problem, const std::vector<int>& part_of_body);

// The lower triangle of S = C_c + J_c H^-1 J_c^T over the interface rows c, with H = system_entries of all
// others. The same error.
std::vector<MatrixEntry> interface_entries(const StepProblem& problem, const std::vector<int>& part_of_body);

}  // namespace cleave
