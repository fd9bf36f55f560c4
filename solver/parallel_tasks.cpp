#include "solver/parallel_tasks.h"

#include <utility>

namespace cleave {

void start_threads(int threads) {
  if (threads <= 1) return;
  constexpr std::chrono::milliseconds kBusy{100};
  const auto end = StageClock::Clock::now() + kBusy;
  const auto spin = [&](int) {
    while (StageClock::Clock::now() < end) {
    }
  };
  StageClock clock;
  ParallelTasks(clock, threads).run(Stage::analyze, threads, spin);
}

void ParallelTasks::begin_background(std::function<void()> work) {
  if (threads() > 1) {
    background_.work = std::move(work);
    return team_.begin(background_);
  }
  clock_.begin_background();
  work();
  clock_.end_background();
}

void ParallelTasks::finish_background(Stage stage) {
  if (threads() == 1) return clock_.join_background();
  if (!background_.work) return;
  const StageTimer timer(clock_, stage);
  team_.finish(background_);
}

void ParallelTasks::cancel_background() { team_.cancel(background_); }

}  // namespace cleave
