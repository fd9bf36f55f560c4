#include "solver/core_round_trip.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cleave {
namespace {

TEST(CoreRoundTrip, OneThreadHasNoOtherCore) { EXPECT_TRUE(std::isnan(core_round_trip_ns(1))); }

// A cache line needs some nanoseconds to any other core. Two threads meet at some time, however busy the
// machine is.
TEST(CoreRoundTrip, IsThatOfACacheLine) {
  for (const int threads : {2, 3, 7}) {
    EXPECT_GT(core_round_trip_ns(threads, std::chrono::hours(1)), 5) << threads;
    for (int k = 0; k < 200; ++k) {
      const double ns = core_round_trip_ns(threads);
      if (!std::isnan(ns)) {
        EXPECT_GT(ns, 5) << threads;
      }
    }
  }
}

}  // namespace
}  // namespace cleave
