// Islands at rest: bodies that rows join, on which the impulses of the step before still solve every row, as
// the judge finds at a first look, in double (rough_row_residuals of solver/residual.h). What rounding hides
// from it is far less than the limit of an exact answer, and the judge looks at the whole step afterwards.
#pragma once

#include <vector>

#include "solver/step_problem.h"

namespace cleave {

// The residual that an island at rest may have: what solvers aim at (SolveOptions) times max(1, largest
// |entry| of v0), m/s.
double rest_limit_m_per_s(const StepProblem& problem);

// Keeps its scratch from one problem to the next.
class RestIslands {
 public:
  // (m) 1 where the row's island is at rest.
  const std::vector<char>& find(const StepProblem& problem);
  // Takes the rows that are 1 (m) to be at rest, whether they are or not.
  void take(const StepProblem& problem, std::vector<char> is_at_rest);

  // (n, 6) Of the last problem: v0 + M^-1 J^T lambda with the impulses of the rows at rest.
  const std::vector<double>& velocity() const { return velocity_; }

 private:
  void join_bodies(const StepProblem& problem);
  void ask_for_first_rows(const StepProblem& problem);
  bool ask_for_islands_at_rest(const StepProblem& problem);
  bool mark_moving(const StepProblem& problem);
  int root_of(int body);
  void restore_moving(const StepProblem& problem);
  int island_of(const StepProblem& problem, int row) const { return parent_[problem.row_body[2 * row]]; }

  std::vector<char> is_at_rest_;  // (m) first what the judge is asked for
  std::vector<double> velocity_;  // (n, 6)
  bool has_rested_ = false;       // anything, in the last problem
  std::vector<char> is_moving_;   // (n) of the root of an island
  std::vector<int> parent_;       // (n) in the end the root
};

}  // namespace cleave
