#include "solver/core_round_trip.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cleave {
namespace {

TEST(CoreRoundTrip, OneThreadHasNoOtherCore) { EXPECT_TRUE(std::isnan(core_round_trip_ns(1))); }

// A cache line needs some nanoseconds to any other core, and two threads meet at some time.
TEST(CoreRoundTrip, IsThatOfACacheLine) {
  for (const int threads : {2, 3, 7}) {
    int known = 0;
    for (int k = 0; k < 200; ++k) {
      const double ns = core_round_trip_ns(threads);
      if (std::isnan(ns)) continue;
      ++known;
      EXPECT_GT(ns, 5);
    }
    EXPECT_GT(known, 0) << threads;
  }
}

}  // namespace
}  // namespace cleave
