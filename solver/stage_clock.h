// The clock of a solve: times of its named stages, and what the same tasks would take on p workers.
// Task times add up to wall time on one thread only, so a solve on more threads has no model. It is made
// (worker_model.h) after the clock has stopped: during the solve task times are only put down.
#pragma once

#include <chrono>
#include <span>
#include <thread>

#include "solver/stage_times.h"
#include "solver/worker_model.h"

namespace cleave {

class StageClock {
 public:
  using Clock = std::chrono::steady_clock;

  // threads: of the solves that are timed. dispatch: what the model charges. models: whether solves on one
  // thread are modelled; no graph may be built anew during one then.
  explicit StageClock(int threads = 1, const DispatchCost& dispatch = {}, bool models = true)
      : models_(threads == 1 && models), model_(dispatch) {}

  void start();                                // begins a solve: all zero
  void add(Stage stage, double milliseconds);  // serial or parallel wall time of a stage
  // What one stage did in the midst of another.
  void move(Stage from, Stage to, double milliseconds);
  bool models() const { return models_; }
  // Where it models: tasks of one parallel stage that has just run (wall times in ms), independent ones, or
  // those of a graph. Else nothing.
  void add_tasks(std::span<const double> task_ms);
  void add_graph(const TaskGraph& graph, std::span<const double> task_ms);
  // The same of a background task: where it begins and ends, no stage between the two, and from when on it is
  // needed; one at a time.
  void begin_background();
  void end_background();
  void join_background();
  StageTimes stop();  // ends the solve, then models it

 private:
  friend class StageTimer;

  double elapsed_ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin_).count();
  }

  bool models_;
  bool timing_ = false;
  std::thread::id thread_;  // that started it
  StageTimes times_;
  RecordedSolve solve_;
  bool has_background_ = false;  // that is not needed yet
  WorkerModel model_;
  Clock::time_point begin_;
};

// Times a scope and adds it to a stage. Inside the scope of another timer it adds nothing: the outermost
// stage counts, so that the stages never overlap (the solves of iterative refinement belong to `refine`). Nor
// does it in a task on another thread than the one that started the clock.
class StageTimer {
 public:
  StageTimer(StageClock& clock, Stage stage)
      : clock_(clock),
        stage_(stage),
        outermost_(std::this_thread::get_id() == clock.thread_ && !clock.timing_),
        begin_(StageClock::Clock::now()) {
    if (outermost_) clock_.timing_ = true;
  }
  ~StageTimer() {
    if (!outermost_) return;
    clock_.timing_ = false;
    clock_.add(stage_, std::chrono::duration<double, std::milli>(StageClock::Clock::now() - begin_).count());
  }
  bool counts() const { return outermost_; }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageClock& clock_;
  Stage stage_;
  bool outermost_;
  StageClock::Clock::time_point begin_;
};

}  // namespace cleave
