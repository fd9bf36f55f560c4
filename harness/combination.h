// One (partitioner, refiner, solver) of a run: what solves a step problem and fills one row of steps.csv.
//
// Every combination has its own solver object, hence its own scratch, and starts from its own copy of the
// warm start: nothing passes between combinations.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/core_meter.h"
#include "harness/friction.h"
#include "harness/ode_baselines.h"
#include "harness/options.h"
#include "harness/splitter.h"
#include "harness/step_record.h"
#include "solver/residual.h"
#include "solver/solution.h"
#include "solver/step_solver.h"

namespace cleave {

struct CombinationName {
  std::string partitioner = "-";  // "-" and "-" for a solver that ignores parts
  std::string refiner = "-";
  std::string solver;
};

// One solve and what the judge says of it.
struct Outcome {
  SolveStatus status =
      SolveStatus::ok;  // the solver's, but not_converged or diverged where the judge disagrees
  SolveSummary summary;
  CoreTimes cores{};  // of the solve
  Solution solution;
  int ode_messages = 0;           // of ODE's own solvers: messages ODE gave while it solved
  std::vector<int> part_of_body;  // (n) what `measure` split the bodies into; empty where parts are ignored
  ResidualReport verdict;
  bool finite = false;  // impulses and velocities are numbers

  // There is a result to judge at all.
  bool solved() const { return has_result(status); }
  bool can_advance() const { return solved() && finite; }
};

class Combination {
 public:
  // solver: a name make_solver accepts; for one that ignores parts the other two names are replaced by
  // "-".
  Combination(CombinationName name, const RunOptions& options);

  const CombinationName& name() const { return name_; }

  void set_names(StepRecord& row) const;

  // What the next problems come from, for solvers that are ODE itself; see OdeBaseline. Others ignore it.
  void see(const OdeWorld& world, std::span<const ContactPoint> contacts);

  // Splits and solves once from the problem's warm start.
  Outcome solve(const StepProblem& problem);

  // Splits and solves options.repeats times from the problem's warm start and fills the row's columns of
  // partition, solve, times and verdict. The stage times are those of the solve with the median time, so that
  // they add up.
  Outcome measure(const StepProblem& problem, StepRecord& row);

  // `box-converged`: iterates the friction bounds of the problem with this combination's solver.
  ConvergedBounds converge_bounds(StepProblem& problem);

 private:
  struct Repeat {
    std::optional<Split> split;  // none for a solver that ignores parts
    Outcome outcome;
  };
  std::optional<Split> split(const StepProblem& problem) const;
  Repeat repeat(const StepProblem& problem);

  CombinationName name_;
  int repeats_;
  double erp_, cfm_;
  std::unique_ptr<StepSolver> solver_;
  OdeBaseline* baseline_;  // solver_ where it is one, else nullptr
  std::optional<Splitter> splitter_;
};

// All combinations of a run in the order of its rows: partitioner, then refiner, then solver; solvers that
// ignore parts come last, once each.
std::vector<Combination> make_combinations(const RunOptions& options);

// One problem measured with every combination. `turn` counts the problems measured before this one: the order
// in which combinations run rotates with it, so that none always has the cold or the warm caches. rows: one a
// combination, already holding the columns of the problem. Returns the outcomes in the order of combinations.
std::vector<Outcome> measure_all(std::span<Combination> combinations, const StepProblem& problem, int turn,
                                 std::span<StepRecord> rows);

// The solver of --advance. Where it needs parts it gets those of the run's first partitioner and refiner.
Combination make_advancing_combination(const RunOptions& options);

}  // namespace cleave
