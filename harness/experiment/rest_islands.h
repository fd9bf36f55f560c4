// Islands at rest: bodies that rows join, on which the impulses of the step before still solve every row.
#pragma once

#include <vector>

#include "solver/prepared_step.h"

namespace cleave {

// Residual of an island at rest over max(1, largest |entry| of v0), m/s: what solvers aim at.
inline constexpr double kRestLimit = 1e-11;

class RestIslands {
 public:
  // (m) 1 where the row's island is at rest. None is where a contact has a cone or Coulomb's law. Scratch is kept from one
  // problem to the next.
  const std::vector<char>& find(const StepProblem& problem);

 private:
  void join_bodies(const StepProblem& problem);
  void mark_moving(const StepProblem& problem);
  int root_of(int body);

  PreparedStep step_;
  std::vector<char> is_at_rest_, is_moving_;  // (m), (n) of the root of an island
  std::vector<int> parent_;                   // (n)
  std::vector<double> impulse_, v_, w_;
};

}  // namespace cleave
