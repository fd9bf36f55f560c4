// Pairs of boxes against every pair tried by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "harness/world/overlapping_boxes.h"
#include "scenarios/scene_random.h"

namespace cleave {
namespace {

using Boxes = std::vector<AxisAlignedBox>;
using Pairs = std::vector<std::pair<int, int>>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Pairs every_pair_tried(const Boxes& boxes) {
  Pairs pairs;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(boxes.size()); ++j) {
      bool apart = false;
      for (int axis = 0; axis < 3; ++axis)
        apart |= boxes[i][2 * axis] > boxes[j][2 * axis + 1] || boxes[j][2 * axis] > boxes[i][2 * axis + 1];
      if (!apart) pairs.emplace_back(i, j);
    }
  return pairs;
}

Pairs sorted_pairs(const Boxes& boxes) {
  Pairs pairs = overlapping_boxes(boxes);
  std::ranges::sort(pairs);
  return pairs;
}

AxisAlignedBox draw_box(SceneRandom& random, double reach, double longest) {
  AxisAlignedBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box[2 * axis] = random.uniform(-reach, reach);
    box[2 * axis + 1] = box[2 * axis] + random.uniform(0, longest);
  }
  return box;
}

TEST(OverlappingBoxes, AreThoseOfEveryPairTried) {
  for (int seed = 1; seed <= 200; ++seed) {
    SceneRandom random(seed);
    Boxes boxes;
    for (int i = 0; i < seed; ++i) boxes.push_back(draw_box(random, 3, seed % 3 == 0 ? 4 : 1));
    const Pairs expected = every_pair_tried(boxes);
    EXPECT_EQ(sorted_pairs(boxes), expected) << "seed " << seed;
    if (seed > 50) {
      EXPECT_GT(expected.size(), 0u);
    }
  }
}

TEST(OverlappingBoxes, MayBeOfAnySize) {
  SceneRandom random(1);
  Boxes boxes;
  for (int i = 0; i < 150; ++i) boxes.push_back(draw_box(random, 3, i % 10 == 0 ? 100 : 0.01));
  EXPECT_EQ(sorted_pairs(boxes), every_pair_tried(boxes));
}

TEST(OverlappingBoxes, MayHaveNoEnd) {
  SceneRandom random(1);
  Boxes boxes;
  for (int i = 0; i < 60; ++i) {
    boxes.push_back(draw_box(random, 3, 1));
    if (i % 10 == 0) boxes.back()[i / 10] = i / 10 % 2 == 0 ? -kInfinity : kInfinity;
  }
  boxes.push_back({-kInfinity, kInfinity, -kInfinity, kInfinity, -kInfinity, kInfinity});
  EXPECT_EQ(sorted_pairs(boxes), every_pair_tried(boxes));
}

TEST(OverlappingBoxes, TouchInAPoint) {
  const Boxes boxes = {{0, 1, 0, 1, 0, 1}, {1, 2, 1, 2, 1, 2}, {2, 3, 1, 2, 3, 4}};
  EXPECT_EQ(sorted_pairs(boxes), (Pairs{{0, 1}}));
}

TEST(OverlappingBoxes, MayAllBeTheSame) {
  const Boxes boxes(40, {0, 1, 0, 1, 0, 1});
  EXPECT_EQ(sorted_pairs(boxes), every_pair_tried(boxes));
  EXPECT_EQ(overlapping_boxes(Boxes{}), Pairs{});
}

}  // namespace
}  // namespace cleave
