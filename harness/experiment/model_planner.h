// --model auto: a step problem is solved without the rows that cannot matter to it, and the judge says
// whether they did.
//
// Left out with impulse 0 are
//     friction rows whose bounds are both 0: mu = 0, or a contact whose normal impulse is predicted to be 0
//     normal rows of contacts that separate, with the friction rows left out above: no impulse in the step
//         before, and a free slack w0 = J v0 - b (h times gravity and the penetration's push-out are in it)
//         greater than the margin
// The margin of a row is the sum, over its bodies, of the greatest speed at which another row of the body is
// violated at the free velocities, max |min(w0, 0)| (bilateral: max |w0|): what the other impulses have to
// change velocities there by. It only decides how often rows come back, never what the answer is.
//
// Left out with the impulse of the step before are
//     islands at rest (rest_islands.h), which the judge has looked at before: no other island changes
//         anything on them
// Islands do not feel each other, so that all others are solved as before. Islands apart and islands of
// bilateral rows need no plan of their own: kernels factor an island apart from others by themselves, and
// keep the factor of one in which no row changed between two iterations.
//
// After a solve the judge (solver/residual.h) looks at the other rows that were left out. One comes back
// where its residual is not exactly 0, and the step is solved again from what was found. Where none comes
// back the full problem has the residual of the reduced one, or that of islands at rest: leaving out costs no
// accuracy.
// Turned boxes, cones and Coulomb's law keep the rows of contacts that separate.
#pragma once

#include <span>
#include <vector>

#include "harness/experiment/rest_islands.h"
#include "solver/step_solver.h"

namespace cleave {

enum class RowPlan : char { solved, zero, at_rest };

inline constexpr int kMostPasses = 4;

// A plan that leaves out less than this share of the rows costs more than it saves, and all rows are solved.
inline constexpr double kLeastShare = 0.1;

// Counts of one planned solve.
struct ModelCounts {
  int rows_left_out = 0;  // of the first pass, with impulse 0
  int rows_at_rest = 0;   // of the first pass, with the impulse of the step before
  int rows_returned = 0;  // of both, in all later passes
  int passes = 1;         // solves
};

// Keeps its scratch from one step to the next.
class ModelPlanner {
 public:
  // As StepSolver::solve on the full problem, parts and solution included. The summary's counts and times are
  // sums over the passes, the planner's own time, the judge's within it included, is serial time, and sizes
  // are those of the last pass.
  SolveSummary solve(StepSolver& solver, const StepProblem& problem, const Parts& parts, Solution& solution,
                     ModelCounts& counts);

  // The same with a given plan (m), of which the judge looks at the rows at rest too, after the solve.
  // Friction rows follow their normal row out and take it along when they come back. After kMostPasses - 1
  // passes all rows come back.
  SolveSummary solve(StepSolver& solver, const StepProblem& problem, const Parts& parts,
                     std::vector<RowPlan> plan, Solution& solution, ModelCounts& counts);

  // (m) What becomes of each row in the first pass.
  std::vector<RowPlan> plan(const StepProblem& problem);

 private:
  void leave_out_separating(const StepProblem& problem, std::vector<RowPlan>& plan) const;
  void reduce(const StepProblem& problem);
  SolveSummary solve_reduced(StepSolver& solver, const Parts& parts);
  SolveSummary solve_pass(StepSolver& solver, const StepProblem& problem, const Parts& parts,
                          Solution& solution);
  SolveSummary solve_planned(StepSolver& solver, const StepProblem& problem, const Parts& parts,
                             Solution& solution, ModelCounts& counts);

  RestIslands rest_;
  std::vector<RowPlan> plan_;
  std::vector<char> is_solved_;  // (m) whether plan_ says so
  bool is_plan_given_ = false;
  StepProblem reduced_;  // the rows that are solved, all bodies, and velocities of rest_; empty without rows
  std::vector<int> new_row_;  // (m) in reduced_
  Solution found_;
};

}  // namespace cleave
