// What a solve on one thread would take on p workers, from what its clock has put down (stage_clock.h).
//
// A parallel stage is a set of tasks (one per subsystem, branch or tile), independent or of a graph. Their
// schedule on p workers (task_schedule.h) gives the makespan of the stage; the solve is modelled as the sum
// of the makespans of its parallel stages plus all serial time. A background task has one of the workers to
// itself until it is done, beside serial time too; whoever needs it waits for what is left of it.
//
// On more than one worker every task is charged what an empty one costs, less what of that its one-thread
// time contains, and every stage, or background task, what it costs to begin and end one; a single task that
// belongs to no graph is done by the caller and pays neither. Communication is left out.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "solver/stage_times.h"
#include "solver/task_schedule.h"

namespace cleave {

// Times in ms, moments since the solve began.
struct RecordedSolve {
  struct Stage {
    std::size_t end;         // where its tasks end in task_ms
    const TaskGraph* graph;  // nullptr: independent
    double end_ms;
  };
  // Begun at begin_ms, its result needed at join_ms: beside the stages first_stage .. end_stage - 1.
  struct Background {
    double begin_ms = 0, ms = 0, join_ms = 0;
    std::size_t first_stage = 0, end_stage = 0;
  };

  void clear();

  double total_ms = 0;
  std::vector<double> task_ms;  // of all parallel stages, one after the other
  std::vector<Stage> stages;
  std::vector<Background> backgrounds;  // one after the other
};

class WorkerModel {
 public:
  explicit WorkerModel(const DispatchCost& dispatch) : dispatch_(dispatch) {}

  // Writes model_ms and critical_path_ms; charges the tasks of the solve.
  void model(RecordedSolve& solve, StageTimes& times);

 private:
  void model_stage(const RecordedSolve::Stage& stage, std::span<double> task_ms);
  void begin_background(const RecordedSolve::Background& background);
  void join_background(const RecordedSolve::Background& background);
  double busy_ms(std::size_t k, double moment_ms) const;

  DispatchCost dispatch_;
  // By number of workers, kModelWorkers and then as many as there are tasks: the difference that the model
  // makes up to the moment it has come to, and when the background task at hand ends.
  std::array<double, kModelWorkers.size() + 1> change_ms_{}, background_end_ms_{};
  std::vector<double> worker_ms_;
  GraphSchedule schedule_;
};

}  // namespace cleave
