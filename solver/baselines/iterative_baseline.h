// The frame of baselines that improve impulse and velocity by iterating: prepares the step on all threads,
// has it iterated, and says not_converged where the residual they leave is above the limit.
//
// Both budgets of an iterative baseline end it, whichever is met first: `sweeps`, and `until`, the judge's
// residual over max(1, largest |v0|). As a look at the residual costs about as much as a sweep, sweeping
// baselines look before the sweeps 0, 1, 2, ... 8, 9, 10, ... 16, 18, 20, ...: the next look is an eighth of
// the sweeps later. So a look costs little, and at most an eighth of the sweeps are made in vain.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "harness/base/parameter.h"
#include "solver/parallel_tasks.h"
#include "solver/prepared_step.h"
#include "solver/stage_clock.h"
#include "solver/step_solver.h"

namespace cleave {

class IterativeBaseline : public StepSolver {
 public:
  // name: of the registry row; must outlive the object.
  IterativeBaseline(std::string_view name, const SolveOptions& options)
      : name_(name),
        stop_(options.stop),
        clock_(options.threads, options.dispatch, options.models_workers),
        tasks_(clock_, options.threads) {}
  bool uses_partition() const override { return false; }

 protected:
  // For iterate() to look at, once an iteration (check_stop).
  const std::atomic<bool>* stop() const { return stop_; }
  // Of the solver's threads; products of the prepared step go over them already.
  ParallelTasks& tasks() { return tasks_; }
  // (n) of the solve, for those that use the partition.
  std::span<const int> part_of_body() const { return part_of_body_; }
  // Of solution.impulse and solution.velocity.
  double residual(const PreparedStep& step, const Solution& solution);

 private:
  // Improves solution.impulse (m), the warm start at first, and solution.velocity = v0 + M^-1 J^T impulse.
  // Returns the number of iterations. A set of impulses that is no interval of a row is refused before.
  virtual int iterate(const PreparedStep& step, Solution& solution) = 0;

  std::string refuse_set(const StepProblem& problem) final;
  SolveSummary do_solve(const StepProblem& problem, const Parts& parts, Solution& solution) final;

  std::string_view name_;
  const std::atomic<bool>* stop_;
  StageClock clock_;
  ParallelTasks tasks_;
  PreparedStep step_;
  std::span<const int> part_of_body_;
  std::vector<double> slack_;
};

// Those whose iterations are sweeps; stop is looked at before each.
class SweepingBaseline : public IterativeBaseline {
 public:
  // settings: `sweeps` and `until` at least.
  SweepingBaseline(std::string_view name, const SolveOptions& options, const Settings& settings)
      : IterativeBaseline(name, options),
        sweeps_(settings.integer("sweeps")),
        until_(settings.number("until")) {}

 private:
  // Once a solve, before the first sweep.
  virtual void begin(const PreparedStep& step) = 0;
  virtual void sweep(const PreparedStep& step, Solution& solution) = 0;

  int iterate(const PreparedStep& step, Solution& solution) final;

  int sweeps_;
  double until_;
};

}  // namespace cleave
