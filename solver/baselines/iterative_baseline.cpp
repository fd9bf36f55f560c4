#include "solver/baselines/iterative_baseline.h"

#include "solver/impulse_set.h"
#include "solver/stop.h"

namespace cleave {

std::string IterativeBaseline::refuse_set(const StepProblem& problem) {
  return find_set_refusal("solver", name_, problem);
}

SolveSummary IterativeBaseline::do_solve(const StepProblem& problem, const Parts& parts, Solution& solution) {
  SolveSummary summary;
  summary.strategy = name_;
  summary.kernel = "-";
  clock_.start();
  {
    StageTimer timer(clock_, Stage::analyze);
    step_.prepare(problem, &tasks_);
    part_of_body_ = parts.part_of_body;
  }
  {
    StageTimer timer(clock_, Stage::predict);
    step_.velocity(solution.impulse, solution.velocity);
    summary.iterations = iterate(step_, solution);
  }
  slack_.resize(problem.row_count());
  step_.velocity(solution.impulse, solution.velocity);
  step_.slack(solution.velocity, solution.impulse, slack_);
  if (!(step_.residual(solution.impulse, slack_) <= step_.exact_limit_m_per_s())) {
    summary.status = SolveStatus::not_converged;
    summary.message = "residual above the limit after the last sweep";
  }
  summary.times = clock_.stop();
  return summary;
}

int SweepingBaseline::iterate(const PreparedStep& step, Solution& solution) {
  begin(step);
  for (int k = 0; k < sweeps_; ++k) {
    check_stop(stop());
    sweep(step, solution);
  }
  return sweeps_;
}

}  // namespace cleave
