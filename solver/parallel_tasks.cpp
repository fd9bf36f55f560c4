#include "solver/parallel_tasks.h"

namespace cleave {

void start_threads(int threads) {
  if (threads <= 1) return;
  constexpr std::chrono::milliseconds kSpin{100};
#pragma omp parallel num_threads(threads)
  {
    const auto end = StageClock::Clock::now() + kSpin;
    while (StageClock::Clock::now() < end) {
    }
  }
}

}  // namespace cleave
