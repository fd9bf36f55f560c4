// The frame of baselines that improve impulse and velocity by iterating: prepares the step, has it iterated, and says
// not_converged where the residual they leave is above the limit.
#pragma once

#include <string_view>
#include <vector>

#include "solver/prepared_step.h"
#include "solver/stage_clock.h"
#include "solver/step_solver.h"

namespace cleave {

class IterativeBaseline : public StepSolver {
 public:
  // name: of the registry row; must outlive the object.
  IterativeBaseline(std::string_view name, const SolveOptions& options)
      : name_(name), stop_(options.stop), clock_(options.threads, options.dispatch) {}
  bool uses_partition() const override { return false; }

 protected:
  // For iterate() to look at, once an iteration (check_stop).
  const std::atomic<bool>* stop() const { return stop_; }
  StageClock& clock() { return clock_; }

 private:
  // Improves solution.impulse (m), the warm start at first, and solution.velocity = v0 + M^-1 J^T impulse. Returns the
  // number of iterations. A set of impulses that is no interval of a row is refused before.
  virtual int iterate(const PreparedStep& step, Solution& solution) = 0;

  std::string refuse_set(const StepProblem& problem) final;
  SolveSummary do_solve(const StepProblem& problem, const Parts& parts, Solution& solution) final;

  std::string_view name_;
  const std::atomic<bool>* stop_;
  StageClock clock_;
  PreparedStep step_;
  std::vector<double> slack_;
};

}  // namespace cleave
