#include "solver/step_solver.h"

#include <algorithm>

#include "solver/impulse_set.h"

namespace cleave {

namespace {

// In the order of the enumeration.
constexpr std::array<const char*, 8> kStatusNames = {"ok",       "not_converged", "timeout", "out_of_memory",
                                                     "diverged", "refused",       "crashed", "skipped"};

}  // namespace

const char* to_string(SolveStatus status) { return kStatusNames[static_cast<std::size_t>(status)]; }

std::optional<SolveStatus> find_status(std::string_view name) {
  const auto found = std::ranges::find(kStatusNames, name);
  if (found == kStatusNames.end()) return std::nullopt;
  return static_cast<SolveStatus>(found - kStatusNames.begin());
}

std::vector<std::string> status_names() { return {kStatusNames.begin(), kStatusNames.end()}; }

bool has_result(SolveStatus status) {
  return status == SolveStatus::ok || status == SolveStatus::not_converged || status == SolveStatus::diverged;
}

bool has_result(std::string_view status) {
  const std::optional<SolveStatus> known = find_status(status);
  return known && has_result(*known);
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
  if (summary.message.empty() && hardest_set(problem) > SetKind::intervals)
    summary.message = refuse_set(problem);
  if (!summary.message.empty()) {
    summary.status = SolveStatus::refused;
    return summary;
  }
  return do_solve(problem, parts, solution);
}

}  // namespace cleave
