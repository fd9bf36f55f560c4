// Matrices of a step problem as Matrix Market text (Boisvert, Pozo and Remington, NISTIR 5935, 1996): a
// header, a comment that says what it is, "rows columns entries", then "row column value" with indices from
// 1, by columns. n bodies, m rows:
//
//     M   6n x 6n, symmetric   mass blocks, kg and kg m^2; body i has rows and columns 6 i + 1 to 6 i + 6
//     J   m x 6n, general      Jacobian, rows in the order of the problem
//     H   6n x 6n, symmetric   M + J^T C^-1 J over all rows, also those at a bound: what a kernel factors
//                              with no row left out
//     S   k x k, symmetric     Schur complement of a partition: C_c + J_c H_p^-1 J_c^T over its k interface
//                              rows c, those that join two parts, in the order of the problem; H_p is H of
//                              all other rows, block diagonal by parts
//
// Symmetric ones hold the lower triangle. Entries that are 0 are left out, and every value reads back
// unchanged.
#pragma once

#include <span>
#include <string>

#include "harness/files/problem_file.h"

namespace cleave {

struct MatrixOfProblem {
  const char* name;
  const char* help;
  bool is_of_partition;
  // partition: of matrices that are of one, else nothing. Throws std::invalid_argument with one line where
  // the problem has no such matrix.
  std::string (*text)(const StepProblem& problem, const StoredPartition* partition);
};
std::span<const MatrixOfProblem> matrices_of_problem();

}  // namespace cleave
