// A step problem as one dense matrix, which is what the solvers of physics engines take:
//
//     A lambda = g + w,   A = J M^-1 J^T + C,   g = b - J v0,
//     lo <= lambda <= hi,  w >= 0 at lo,  w <= 0 at hi,  w = 0 between.
//
// Local form and Delassus matrix are other names of it. Written from the arrays of step_problem.h alone.
#pragma once

#include <vector>

#include "solver/step_problem.h"

namespace cleave {

struct DenseProblem {
  int rows = 0;                    // m
  std::vector<double> matrix;      // (m, m) A, row-major, symmetric to the last bit
  std::vector<double> right_side;  // (m) g
};

DenseProblem make_dense_problem(const StepProblem& problem);

}  // namespace cleave
