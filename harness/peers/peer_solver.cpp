#include "harness/peers/peer_solver.h"

#include <algorithm>
#include <limits>

#include "harness/base/value_spans.h"
#include "harness/peers/peer_process.h"
#include "solver/impulse_set.h"
#include "solver/residual.h"

namespace cleave {
namespace {

const char* law_text(ContactSet law) {
  switch (law) {
    case ContactSet::box:
      return "boxes";
    case ContactSet::cone:
      return "cones";
    case ContactSet::coulomb:
      return "Coulomb's law";
  }
  return "";
}

StageTimes times_of(double solve_ms) {
  StageTimes times;
  times.stage_ms.fill(0.0);  // what happens inside is not known
  times.total_ms = solve_ms;
  return times;
}

}  // namespace

// Asked where a set is no interval of a row: boxes that are turned, and what find_refusal looks at more
// closely.
std::string PeerSolver::refuse_set(const StepProblem& problem) {
  const bool turned = std::ranges::any_of(problem.box_angle_rad, [](double angle) { return angle != 0; });
  return turned ? find_set_refusal("solver", name_, problem) : "";
}

std::string PeerSolver::find_refusal(const StepProblem& problem) const {
  const int most = settings_.integer(parameters::peer_max_rows().name);
  if (problem.row_count() > most)
    return std::to_string(problem.row_count()) + " rows, more than --peer-max-rows " + std::to_string(most);
  for (int r = 0; r < problem.row_count(); ++r) {
    const ContactSet law = problem.contact_set.empty() ? ContactSet::box : problem.contact_set[r];
    if (problem.row_kind[r] == RowKind::normal && law != law_)
      return std::string("solver ") + name_ + " takes contacts of " + law_text(law_) + "; that of row " +
             std::to_string(r) + " has " + law_text(law);
  }
  return "";
}

SolveSummary PeerSolver::do_solve(const StepProblem& problem, const Parts&, Solution& solution) {
  SolveSummary summary;
  summary.strategy = name_;
  summary.kernel = "-";
  summary.iterations = summary.factorizations = summary.interface_unknowns = -1;
  summary.fallbacks = summary.refinements = -1;
  summary.factor_mflop_local = summary.factor_mflop_interface = summary.factor_mflop_done =
      std::numeric_limits<double>::quiet_NaN();
  summary.message = find_refusal(problem);
  if (!summary.message.empty()) {
    summary.status = SolveStatus::refused;
    return summary;
  }
  const auto work = [&] { return solve_(problem, solution.impulse, settings_); };
  const PeerEnd end = run_peer(work, settings_.number(parameters::peer_timeout().name), stop_);
  summary.status = end.status;
  summary.message = end.message;
  if (end.status != SolveStatus::ok) return summary;
  if (end.answer.impulse.empty() && problem.row_count() > 0) {
    summary.status = SolveStatus::refused;
    summary.message = end.answer.message;
    return summary;
  }
  summary.iterations = end.answer.iterations;
  summary.times = times_of(end.answer.solve_ms);
  solution.impulse = end.answer.impulse;
  const ResidualReport verdict = judge(problem, solution.impulse);
  solution.velocity = verdict.velocity;
  if (verdict.exact) return summary;
  summary.status = SolveStatus::not_converged;
  if (!all_finite(solution.impulse)) summary.status = SolveStatus::diverged;
  summary.message = end.answer.message.empty() ? "residual above the limit; the library reports success"
                                               : end.answer.message;
  return summary;
}

}  // namespace cleave
