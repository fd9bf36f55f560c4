// Problems whose contacts obey Coulomb's law.
#pragma once

#include <limits>

#include "tests/solver/problem_makers.h"

namespace cleave {

inline StepProblem with_coulomb(StepProblem problem) {
  problem.contact_set.assign(problem.row_count(), ContactSet::box);
  const double infinity = std::numeric_limits<double>::infinity();
  for (int r = 0; r < problem.row_count(); ++r) {
    if (problem.row_kind[r] == RowKind::normal) problem.contact_set[r] = ContactSet::coulomb;
    if (problem.row_kind[r] != RowKind::friction) continue;
    problem.lower[r] = -infinity;
    problem.upper[r] = infinity;
  }
  return problem;
}

}  // namespace cleave
