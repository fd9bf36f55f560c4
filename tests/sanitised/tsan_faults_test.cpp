// A race that is there on purpose: it has to end the program with the exit code of a finding. And what only
// OpenMP orders: it has to be none, or the sanitiser does not see OpenMP's order.
#include <gtest/gtest.h>
#include <omp.h>

#include <atomic>
#include <cstdlib>

#include "solver/worker_team.h"

namespace cleave {
namespace {

struct Shared {
  std::atomic<int> step{0};
  int sum = 0;
};

void wait_for(const std::atomic<int>& step, int value) {
  while (step.load(std::memory_order_relaxed) != value) {
  }
}

// Both tasks are under way before either adds, and then one adds after the other: of two accesses at the same
// instant the sanitiser may miss one. Relaxed order: nothing that it could take for order.
void add_unordered(void* context, int index) {
  Shared& shared = *static_cast<Shared*>(context);
  if (index == 0) {
    wait_for(shared.step, 1);
    ++shared.sum;
    shared.step.store(2, std::memory_order_relaxed);
  } else {
    shared.step.store(1, std::memory_order_relaxed);
    wait_for(shared.step, 2);
    ++shared.sum;
  }
}

void race() {
  Shared shared;
  WorkerTeam(2).run(2, add_unordered, &shared);
}

void order_by_a_barrier() {
  int sum = 0;
#pragma omp parallel num_threads(2)
  {
    if (omp_get_thread_num() == 0) ++sum;
#pragma omp barrier
    if (omp_get_thread_num() == 1) ++sum;
  }
  std::exit(sum == 2 ? EXIT_SUCCESS : EXIT_FAILURE);
}

constexpr int kFinding = 66;

TEST(PlantedRaceDeathTest, EndsTheProgram) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(race(), ::testing::ExitedWithCode(kFinding), "data race");
}

TEST(OpenMpDeathTest, OrdersItsThreads) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(order_by_a_barrier(), ::testing::ExitedWithCode(EXIT_SUCCESS), "");
}

}  // namespace
}  // namespace cleave
