// The solution of a small step problem by trying every active set: each row free, at lo or at hi, at most 3^m
// sets.
//
// With A = J M^-1 J^T + C and q = J v0 - b, a set with free rows F and bounded rows B gives
//     A_FF lambda_F = -(q_F + A_FB lambda_B),   w = A lambda + q,
// and the set that violates bounds and signs least is the answer. Dense, in extended precision, and written
// from step_problem.h alone.
#pragma once

#include <vector>

#include "solver/step_problem.h"

namespace cleave {

inline constexpr int kOracleMostRows = 10;

struct OracleSolution {
  std::vector<double> impulse;         // (m)
  std::vector<double> velocity;        // (n, 6)
  double worst_violation_m_per_s = 0;  // of the best set, in the unit of w: rounding error only
  int sets = 0;                        // active sets whose equations were solved
};

// Throws std::invalid_argument where m > kOracleMostRows or a row has C = 0 (the solution may not be unique).
OracleSolution solve_by_enumeration(const StepProblem& problem);

}  // namespace cleave
