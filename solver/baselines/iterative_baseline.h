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
  IterativeBaseline(std::string_view name, int threads) : name_(name), clock_(threads) {}
  bool uses_partition() const override { return false; }

 private:
  // Improves solution.impulse (m), the warm start at first, and solution.velocity = v0 + M^-1 J^T impulse. Returns the
  // number of iterations. A set of impulses that is no interval of a row is refused before.
  virtual int iterate(const PreparedStep& step, Solution& solution) = 0;

  std::string refuse_set(const StepProblem& problem) final;
  SolveSummary do_solve(const StepProblem& problem, std::span<const int> part_of_body,
                        Solution& solution) final;

  std::string_view name_;
  StageClock clock_;
  PreparedStep step_;
  std::vector<double> slack_;
};

}  // namespace cleave
