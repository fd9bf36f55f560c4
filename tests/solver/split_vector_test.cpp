// Numbers of extended precision come back from two doubles as they were.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "solver/residual_bodies.h"

namespace cleave::judging {
namespace {

TEST(SplitVector6, GivesBackAllBits) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-900, 1020);
  for (int turn = 0; turn < 10000; ++turn) {
    Vector6<Extended> numbers;
    for (int k = 0; k < 6; ++k)
      numbers[k] = std::ldexp(static_cast<Extended>(random()) * (random() % 2 == 0 ? 1 : -1),
                              static_cast<int>(exponent(random)) - 64);
    const Vector6<Extended> back = SplitVector6(numbers).sum();
    ASSERT_EQ(back, numbers) << "turn " << turn;
  }
}

TEST(SplitVector6, KeepsZeroAndWhatIsNoNumber) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vector6<Extended> numbers;
  numbers << 0, -1, kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN(), 1;
  const Vector6<Extended> back = SplitVector6(numbers).sum();
  for (const int k : {0, 1, 2, 3, 5}) EXPECT_EQ(back[k], numbers[k]) << k;
  EXPECT_TRUE(std::isnan(back[4]));
}

}  // namespace
}  // namespace cleave::judging
