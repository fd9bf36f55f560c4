// The step loop: ODE finds contacts, the harness turns them into a step problem, every combination solves it,
// one solution advances the world.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "harness/experiment/combination.h"
#include "harness/experiment/options.h"
#include "harness/experiment/run_summary.h"
#include "harness/world/ode_world.h"
#include "harness/world/step_context.h"

namespace cleave {

// A step as an observer sees it: who solved it, if it was measured, and what came out.
struct ObservedStep {
  const StepContext& context;
  const StepProblem& problem;
  int step;
  std::span<StepRecord> rows;  // one a combination on a measured step, else empty; columns may be filled
  std::span<const Outcome> outcomes;  // in the order of rows
};

class Simulation {
 public:
  using Progress = std::function<void(long long steps_done, long long steps_total)>;
  // Sees every step whose solves are done, before the world is advanced.
  using Observer = std::function<void(const ObservedStep& step)>;
  // Takes the rows of a measured step when the step is over.
  using RowSink = std::function<void(std::span<const StepRecord> rows)>;

  // Makes every solver, partitioner and refiner, without touching ODE or the disk. stop: once true, no solve
  // begins, the one at hand ends at its next iteration, and the step at hand leaves no row.
  Simulation(const RunOptions& options, const std::atomic<bool>& stop, Observer observe = {});
  Simulation(const Simulation&) = delete;  // combinations look at its context
  Simulation& operator=(const Simulation&) = delete;

  // Runs all steps (--mode separate: of one world after the other) and hands on each measured step's rows
  // when the step is over. Throws std::runtime_error when a scene holds something that cannot be extracted,
  // or when rows cannot be written.
  RunSummary run(const RowSink& write, const Progress& progress);

 private:
  // The rows of one measured step and the solutions they stand for.
  struct Measured {
    std::vector<StepRecord> rows;
    std::vector<Outcome> outcomes;
  };

  void run_worlds(const RowSink& write, const Progress& progress);
  void run_world(std::span<Combination> combinations, Combination& advancing, const RowSink& write,
                 const Progress& progress);
  StepProblem pose_problem(OdeWorld& world, ContactMemory& memory, Combination& advancing,
                           StepRecord& common);
  void set_friction(StepProblem& problem, Combination& advancing, int step);
  Measured measure(std::span<Combination> combinations, const StepProblem& problem, const StepRecord& common);
  void count_step(const Measured& measured, const Outcome& advance);
  void finish_rows(Measured& measured, const OdeWorld& world, const Outcome& advance);
  void record(std::span<const StepRecord> rows, const RowSink& write);
  void record_skipped(std::span<const Combination> combinations, int first_step, const std::string& reason,
                      const RowSink& write);

  StepRecord blank_row(int step) const;
  long long total_steps() const;
  bool is_measured(int step) const;

  RunOptions options_;
  const std::atomic<bool>& stop_;
  Observer observe_;
  std::vector<ContactPoint> contacts_;  // of the step at hand, as is
  StepContext context_;
  StepRecord run_row_;  // the columns all rows share
  std::vector<Combination> combinations_;
  RunSummary summary_;
};

}  // namespace cleave
