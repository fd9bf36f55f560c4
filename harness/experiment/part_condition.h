// How badly conditioned the subsystems of a partition are.
//
// Of part i, with D = 1 / C on every row whose bodies are all in the part or static,
//
//     H_i = M_i + J_i^T D J_i
//
// is what the Schur complement kernel factors when no row of the part is at a bound. Its condition number is
// that of the 1-norm, with masses in kg, lengths in m; the norm of the inverse is estimated, usually exactly
// and never too large (Hager 1984; Higham, ACM TOMS 14, 1988). Liu and Andrews (2022, section 3.2) join
// bodies of like mass so that it stays small.
#pragma once

#include <span>

#include "harness/experiment/cell_measures.h"
#include "solver/step_problem.h"

namespace cleave {

inline constexpr int kMostConditionBodies = 500;  // of a part: its dense H_i then takes 72 MB

// The largest over the parts; part_of_body: (n). Infinity where an interior row has no compliance or H_i is
// singular to working precision, NaN where a part has more than kMostConditionBodies bodies.
double largest_part_condition(const StepProblem& problem, std::span<const int> part_of_body);

// Of a cell; NaN for a solver that ignores parts.
double largest_part_condition(const Cell& cell);

}  // namespace cleave
