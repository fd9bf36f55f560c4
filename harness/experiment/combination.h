// One (partitioner, refiner, solver) of a run: what solves a step problem and fills one row of steps.csv.
//
// Every combination has its own solver object, hence its own scratch, and starts from its own copy of the
// warm start: nothing passes between combinations.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/base/combination_label.h"
#include "harness/experiment/core_meter.h"
#include "harness/experiment/friction_converged.h"
#include "harness/experiment/model_planner.h"
#include "harness/experiment/options.h"
#include "harness/experiment/partition_keeper.h"
#include "harness/experiment/splitter.h"
#include "harness/experiment/step_record.h"
#include "partition/partition.h"
#include "solver/residual.h"
#include "solver/solution.h"
#include "solver/step_solver.h"

namespace cleave {

struct CombinationName {
  std::string partitioner = "-";  // "-" and "-" for a solver that ignores parts
  std::string refiner = "-";
  std::string solver;

  std::string label() const { return combination_label(partitioner, refiner, solver); }
};

// One solve and what the judge says of it.
struct Outcome {
  SolveStatus status =
      SolveStatus::ok;  // the solver's, but not_converged or diverged where the judge disagrees
  SolveSummary summary;
  CoreTimes cores{};  // of the solve
  ModelCounts model;  // of --model auto
  Solution solution;
  Partition parts;  // what `measure` split the bodies into; of none where parts are ignored
  PartitionOrigin origin = PartitionOrigin::fresh;
  ResidualReport verdict;
  bool finite = false;  // impulses and velocities are numbers

  // There is a result to judge at all.
  bool solved() const { return has_result(status); }
  bool can_advance() const { return solved() && finite; }
};

class Combination {
 public:
  // Where the solver ignores parts partitioner and refiner are not made. context: what solvers that are ODE
  // itself read the step from, and partitioners the positions. stop, where given: once true no solve begins
  // and the one at hand ends with Stopped, out of every function below. Both must outlive the combination.
  Combination(const Algorithm& partitioner, const Algorithm& refiner, const Algorithm& solver,
              const RunOptions& options, const StepContext& context, const std::atomic<bool>* stop = nullptr);

  const CombinationName& name() const { return name_; }

  // Who splits; of a solver that ignores parts both have no name.
  const SplitSetup& split_setup() const { return setup_; }

  // Names and parameters.
  void set_names(StepRecord& row) const;

  // Splits and solves once from the problem's warm start. step: of the run. A partitioner that cannot split
  // this step makes the outcome `refused`, a lack of memory `out_of_memory`; the next solve begins afresh.
  Outcome solve(const StepProblem& problem, int step);

  // Splits without solving, for what the partition of the next step is made from. Does nothing where every
  // step is split anew.
  void follow(const StepProblem& problem, int step);

  // Splits and solves options.repeats times from the problem's warm start, at the row's step, and fills the
  // row's columns of partition, solve, times and verdict. The stage times are those of the solve with the
  // median time, so that they add up.
  Outcome measure(const StepProblem& problem, StepRecord& row);

  // `box-converged`: iterates the friction bounds of the problem with this combination's solver. Where the
  // step cannot be split they stay as predicted, unconverged.
  ConvergedBounds converge_bounds(StepProblem& problem, int step);

 private:
  struct Repeat {
    std::optional<Split> split;  // none for a solver that ignores parts and for a step that cannot be split
    Outcome outcome;
  };
  std::optional<Split> split(const StepProblem& problem, int step) const;
  void remember(const std::optional<Split>& split);
  Repeat repeat(const StepProblem& problem, int step);
  std::vector<Repeat> repeat_all(const StepProblem& problem, int step);
  void solve_parts(const StepProblem& problem, const Parts& parts, Outcome& outcome);

  CombinationName name_;
  SplitSetup setup_;
  Algorithm solver_named_;
  int repeats_;
  SolveOptions solve_options_;
  const StepContext* context_;
  std::unique_ptr<StepSolver> solver_;   // none after a solve without memory: the next one makes it anew
  std::optional<ModelPlanner> planner_;  // of --model auto
  std::optional<Splitter> splitter_;
  PartitionKeeper keeper_;
};

// All combinations of a run in the order of its rows: partitioner, then refiner, then solver; solvers that
// ignore parts come last, once each.
std::vector<Combination> make_combinations(const RunOptions& options, const StepContext& context,
                                           const std::atomic<bool>* stop = nullptr);

// The names of make_combinations, in its order.
std::vector<CombinationName> combination_names(const RunOptions& options);

// One problem measured with every combination. `turn` counts the problems measured before this one: the order
// in which combinations run rotates with it, so that none always has the cold or the warm caches. rows: one a
// combination, already holding the columns of the problem. Returns the outcomes in the order of combinations.
std::vector<Outcome> measure_all(std::span<Combination> combinations, const StepProblem& problem, int turn,
                                 std::span<StepRecord> rows);

// What advances a world knows no step before and no numbers but the scene's, so that the world goes the same
// way whatever combinations remember and split by.
RunOptions without_history(RunOptions options);

// The solver of --advance. Where it needs parts it gets those of the run's first partitioner and refiner.
Combination make_advancing_combination(const RunOptions& options, const StepContext& context,
                                       const std::atomic<bool>* stop = nullptr);

}  // namespace cleave
