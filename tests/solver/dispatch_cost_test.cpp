// What handing out tasks costs here: numbers that a machine can have, and one answer a process.
#include "solver/dispatch_cost.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cleave {
namespace {

TEST(DispatchCostTest, EveryCostIsMeasured) {
  const DispatchCost cost = measure_dispatch_cost();
  for (const double us : {cost.timing_us, cost.task_us, cost.graph_task_us, cost.stage_us})
    EXPECT_TRUE(std::isfinite(us)) << us;
  EXPECT_GT(cost.timing_us, 0);
  EXPECT_GT(cost.stage_us, 0);
}

TEST(DispatchCostTest, AProcessMeasuresOnce) {
  EXPECT_EQ(&dispatch_cost(), &dispatch_cost());
  EXPECT_GT(dispatch_cost().stage_us, 0);
}

}  // namespace
}  // namespace cleave
