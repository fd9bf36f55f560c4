// A race that is there on purpose: it has to end the program with the exit code of a finding. And what only OpenMP
// orders: it has to be none, or the sanitiser does not see OpenMP's order.
#include <gtest/gtest.h>
#include <omp.h>

#include <atomic>
#include <cstdlib>

#include "solver/worker_team.h"

namespace cleave {
namespace {

struct Shared {
  std::atomic<int> started{0};
  int sum = 0;
};

// Both tasks are under way before either adds. Relaxed order: nothing that the sanitiser could take for order.
void add_unordered(void* context, int) {
  Shared& shared = *static_cast<Shared*>(context);
  shared.started.fetch_add(1, std::memory_order_relaxed);
  while (shared.started.load(std::memory_order_relaxed) < 2) {
  }
  ++shared.sum;
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
