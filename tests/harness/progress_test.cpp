#include "harness/base/progress.h"

#include <gtest/gtest.h>

namespace cleave {
namespace {

TEST(ExpectedSeconds, AreThoseOfTheLastLine) {
  EXPECT_EQ(expected_seconds("rock_pile: step 34 of 500, 10 s, about 137 s to go\n"), 147);
  EXPECT_EQ(
      expected_seconds("a remark\nrock_pile: step 34 of 500, 10 s, about 137 s to go\n"
                       "rock_pile: step 70 of 500, 20 s, about 123 s to go\nthe world stopped at step 80\n"),
      143);
}

TEST(ExpectedSeconds, AreUnknownWithoutALine) {
  for (const char* printed : {"", "nothing of the kind\n", "rock_pile: step 34 of 500, 10", "step by step\n"})
    EXPECT_FALSE(expected_seconds(printed)) << printed;
}

}  // namespace
}  // namespace cleave
