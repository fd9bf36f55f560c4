// A race that is there on purpose: it has to end the program with the exit code of a finding.
#include <gtest/gtest.h>

#include <atomic>

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

constexpr int kFinding = 66;

TEST(PlantedRaceDeathTest, EndsTheProgram) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(race(), ::testing::ExitedWithCode(kFinding), "data race");
}

}  // namespace
}  // namespace cleave
