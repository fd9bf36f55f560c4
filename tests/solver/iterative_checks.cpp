#include "tests/solver/iterative_checks.h"

#include <algorithm>

#include "solver/registry.h"
#include "solver/residual.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {

Iterated iterate_by(const std::string& solver, const StepProblem& problem, int parts, int threads) {
  Iterated iterated{{}, cold_start(problem)};
  iterated.summary = make_step_solver(solver, {.threads = threads})
                         ->solve(problem, sliced_parts(problem.body_count(), parts), iterated.solution);
  return iterated;
}

// With v = v0 + M^-1 J^T lambda: lambda^T (J (v + v0) / 2 + C lambda / 2 - b).
double energy_of(const StepProblem& problem, const std::vector<double>& impulse) {
  const std::vector<double> v = judge(problem, impulse).velocity;
  double energy = 0;
  for (int r = 0; r < problem.row_count(); ++r) {
    double rate = problem.compliance[r] * impulse[r] / 2 - problem.rhs[r];
    for (int c = 0; c < 12; ++c) {
      const int body = problem.row_body[2 * r + c / 6];
      if (body < 0) continue;
      const int entry = 6 * body + c % 6;
      rate += problem.jacobian[12 * r + c] * (v[entry] + problem.free_velocity[entry]) / 2;
    }
    energy += impulse[r] * rate;
  }
  return energy;
}

}  // namespace cleave
