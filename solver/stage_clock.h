// The clock of a solve: times of its named stages, and what the same tasks would take on p workers.
//
// A parallel stage is a set of tasks (one per subsystem, branch or tile), independent or of a graph. Their schedule
// on p workers (task_schedule.h) gives the makespan of the stage; a solve on p workers is then modelled as the sum
// of the makespans of its parallel stages plus all serial time. Task times add up to wall time on one thread only, so
// a solve on more threads has no model. The model is made after the clock has stopped: during the solve task times are
// only put down.
#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <vector>

#include "solver/stage_times.h"
#include "solver/task_schedule.h"

namespace cleave {

class StageClock {
 public:
  using Clock = std::chrono::steady_clock;

  // threads: of the solves that are timed. graphs_stay: none is built anew during a solve; else there is no model.
  explicit StageClock(int threads = 1, bool graphs_stay = true) : models_(threads == 1 && graphs_stay) {}

  void start();                                // begins a solve: all zero
  void add(Stage stage, double milliseconds);  // serial or parallel wall time of a stage
  // Tasks of one parallel stage that has just run (wall times in ms): independent ones, or those of a graph.
  void add_tasks(std::span<const double> task_ms);
  void add_graph(const TaskGraph& graph, std::span<const double> task_ms);
  StageTimes stop();  // ends the solve, then models it

 private:
  friend class StageTimer;
  void model();

  bool models_;
  bool timing_ = false;
  StageTimes times_;
  std::vector<double> task_ms_;  // of all parallel stages of the solve, one after the other
  struct ParallelStage {
    std::size_t end;         // where its tasks end in task_ms_
    const TaskGraph* graph;  // nullptr: independent
  };
  std::vector<ParallelStage> stages_;
  std::vector<double> worker_ms_;
  GraphSchedule schedule_;
  Clock::time_point begin_;
};

// Times a scope and adds it to a stage. Inside the scope of another timer it adds nothing: the outermost
// stage counts, so that the stages never overlap (the solves of iterative refinement belong to `refine`).
class StageTimer {
 public:
  StageTimer(StageClock& clock, Stage stage)
      : clock_(clock), stage_(stage), outermost_(!clock.timing_), begin_(StageClock::Clock::now()) {
    clock_.timing_ = true;
  }
  ~StageTimer() {
    if (!outermost_) return;
    clock_.timing_ = false;
    clock_.add(stage_, std::chrono::duration<double, std::milli>(StageClock::Clock::now() - begin_).count());
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageClock& clock_;
  Stage stage_;
  bool outermost_;
  StageClock::Clock::time_point begin_;
};

}  // namespace cleave
