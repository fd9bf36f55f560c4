#include "solver/step_solver.h"

#include <cassert>

#include "solver/impulse_set.h"

namespace cleave {

const char* to_string(SolveStatus status) {
  constexpr std::array<const char*, 8> names = {"ok",       "not_converged", "timeout", "out_of_memory",
                                                "diverged", "refused",       "crashed", "skipped"};
  return names[static_cast<std::size_t>(status)];
}

bool has_result(SolveStatus status) {
  return status == SolveStatus::ok || status == SolveStatus::not_converged ||
         status == SolveStatus::timeout || status == SolveStatus::diverged;
}

std::string StepSolver::refuse_set(const StepProblem& problem) {
  return find_set_refusal("this", "solver", problem);
}

SolveSummary StepSolver::solve(const StepProblem& problem, const Parts& parts, Solution& solution) {
  SolveSummary summary;
  solution.velocity.resize(problem.free_velocity.size());
  solution.impulse.resize(problem.rhs.size(), 0.0);
  summary.message = find_problem_error(problem);
  if (summary.message.empty() && uses_partition())
    summary.message = parts_check_.find_error(parts, problem.body_count());
  if (summary.message.empty() && !has_intervals_only(problem)) summary.message = refuse_set(problem);
  if (!summary.message.empty()) {
    summary.status = SolveStatus::refused;
    return summary;
  }
  return do_solve(problem, parts, solution);
}

}  // namespace cleave
