#include "solver/baselines/iterative_baseline.h"

#include <algorithm>

#include "harness/base/stop.h"
#include "solver/impulse_set.h"

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
  step_.velocity(solution.impulse, solution.velocity);
  if (!(residual(step_, solution) <= step_.exact_limit_m_per_s())) {
    summary.status = SolveStatus::not_converged;
    summary.message = "residual above the limit after the last sweep";
  }
  summary.times = clock_.stop();
  return summary;
}

double IterativeBaseline::residual(const PreparedStep& step, const Solution& solution) {
  slack_.resize(step.row_count());
  step.slack(solution.velocity, solution.impulse, slack_);
  return step.residual(solution.impulse, slack_);
}

int SweepingBaseline::iterate(const PreparedStep& step, Solution& solution) {
  begin(step);
  int next_look = until_ > 0 ? 0 : sweeps_;
  for (int done = 0; done < sweeps_; ++done) {
    check_stop(stop());
    if (done == next_look) {
      if (residual(step, solution) <= until_ * step.velocity_scale()) return done;
      next_look += std::max(1, done / 8);
    }
    sweep(step, solution);
  }
  return sweeps_;
}

}  // namespace cleave
