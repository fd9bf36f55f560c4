// Times of the named stages of a solve, as solvers report them.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

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
inline constexpr std::array<int, 7> kModelWorkers = {1, 2, 4, 8, 16, 32, 64};

// What it costs to hand out the tasks of a parallel stage (dispatch_cost.h); the model charges it on more
// than one worker. Zeros: nothing is charged.
struct DispatchCost {
  double timing_us = 0;      // what the one-thread time of an empty task contains: reading the clock
  double task_us = 0;        // an empty task, of those that wait for none
  double graph_task_us = 0;  // an empty task of a graph
  double stage_us = 0;       // until others have begun, and until the caller knows that all is done
};

// NaN where nothing was measured. model_ms: the same solve on so many workers, critical_path_ms: on as many
// as there are tasks (stage_clock.h).
struct StageTimes {
  std::array<double, kStageNames.size()> stage_ms = unmeasured<kStageNames.size()>();
  double total_ms = kNotTimed;  // t_s; t_s_other = total - sum of the stages
  std::array<double, kModelWorkers.size()> model_ms = unmeasured<kModelWorkers.size()>();
  double critical_path_ms = kNotTimed;

 private:
  static constexpr double kNotTimed = std::numeric_limits<double>::quiet_NaN();
  template <std::size_t N>
  static constexpr std::array<double, N> unmeasured() {
    std::array<double, N> values{};
    values.fill(kNotTimed);
    return values;
  }
};

}  // namespace cleave
