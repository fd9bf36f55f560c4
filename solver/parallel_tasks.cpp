#include "solver/parallel_tasks.h"

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

}  // namespace cleave
