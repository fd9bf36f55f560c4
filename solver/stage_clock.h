// Times of the named stages of a solve, and what the same tasks would take on p workers.
//
// A parallel stage is a set of independent tasks (one per subsystem, or per tile of the interface). Its
// modelled makespan on p workers gives the longest task first to the worker that is free first; a solve on p
// workers is then modelled as the sum of the makespans of its parallel stages plus all serial time. Task
// times mean something only when measured on one thread.
#pragma once

#include <array>
#include <chrono>
#include <span>
#include <string_view>
#include <vector>

namespace cleave {

enum class Stage {
  analyze,
  predict,
  assemble,
  factor_local,
  form_interface,
  factor_interface,
  solve,
  check,
  refine
};
inline constexpr std::array<std::string_view, 9> kStageNames = {
    "analyze",          "predict", "assemble", "factor_local", "form_interface",
    "factor_interface", "solve",   "check",    "refine"};
inline constexpr std::array<int, 5> kModelWorkers = {1, 2, 4, 8, 16};

struct StageTimes {
  std::array<double, kStageNames.size()> stage_ms{};
  double total_ms = 0;  // t_s; t_s_other = total - sum of the stages
  std::array<double, kModelWorkers.size()> model_ms{};
};

class StageClock {
 public:
  using Clock = std::chrono::steady_clock;

  void start();                                // begins a solve: all zero
  void add(Stage stage, double milliseconds);  // serial or parallel wall time of a stage
  // Tasks of one parallel stage that has just run (wall times in ms).
  void add_tasks(std::span<const double> task_ms);
  StageTimes stop();  // ends the solve

 private:
  friend class StageTimer;
  bool timing_ = false;
  StageTimes times_;
  double parallel_ms_ = 0;  // sum of all task times
  std::array<double, kModelWorkers.size()> makespan_ms_{};
  std::vector<double> sorted_ms_;
  std::vector<double> worker_ms_;
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

// Longest-task-first makespan of tasks on p workers. sorted and worker are scratch.
double makespan_ms(std::span<const double> sorted_descending_ms, int workers, std::vector<double>& worker_ms);

}  // namespace cleave
