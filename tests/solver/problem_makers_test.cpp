// The makers promise variety; a generator that quietly lost a case would make every test above it weaker.
#include "tests/solver/problem_makers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/solver/enumeration_oracle.h"

namespace cleave {
namespace {

TEST(SmallProblemTest, CoversEveryKindOfRowAndState) {
  int fixed = 0, one_sided = 0, unbounded = 0, zero_friction = 0, with_static = 0, copies = 0, most_rows = 0;
  int free = 0, at_bound = 0, degenerate = 0, at_rest = 0, heavy = 0;
  for (int seed = 0; seed < 300; ++seed) {
    const StepProblem p = make_small_problem(seed);
    const OracleSolution oracle = solve_by_enumeration(p);
    most_rows += p.row_count() == kOracleMostRows;
    at_rest += std::all_of(oracle.impulse.begin(), oracle.impulse.end(), [](double x) { return x == 0; });
    heavy += std::any_of(p.mass.begin(), p.mass.end(), [](double x) { return x > 1e4; });
    for (int r = 0; r < p.row_count(); ++r) {
      fixed += p.lower[r] == p.upper[r];
      unbounded += std::isinf(p.lower[r]) && std::isinf(p.upper[r]);
      one_sided += std::isinf(p.lower[r]) != std::isinf(p.upper[r]);
      zero_friction += p.row_kind[r] == RowKind::friction && p.upper[r] == 0;
      with_static += p.row_body[2 * r + 1] == -1;
      for (int s = 0; s < r; ++s) {
        copies += std::equal(&p.jacobian[12 * r], &p.jacobian[12 * r] + 12, &p.jacobian[12 * s]);
      }
      const bool bounded = oracle.impulse[r] == p.lower[r] || oracle.impulse[r] == p.upper[r];
      double slack = p.compliance[r] * oracle.impulse[r] - p.rhs[r];
      for (int k = 0; k < 12; ++k) {
        const int body = p.row_body[2 * r + k / 6];
        if (body >= 0) slack += p.jacobian[12 * r + k] * oracle.velocity[6 * body + k % 6];
      }
      (bounded ? at_bound : free) += 1;
      degenerate += bounded && std::abs(slack) < 1e-12;
    }
  }
  for (const int count : {fixed, one_sided, unbounded, zero_friction, with_static, copies, most_rows, free,
                          at_bound, degenerate, at_rest, heavy}) {
    EXPECT_GE(count, 10);
  }
}

TEST(SmallProblemTest, SameSeedSameProblem) {
  const StepProblem a = make_small_problem(7), b = make_small_problem(7), c = make_small_problem(8);
  EXPECT_EQ(a.jacobian, b.jacobian);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_NE(a.jacobian, c.jacobian);
}

TEST(StructureTest, HasTheRowsItsShapeImplies) {
  const StepProblem tower = make_pile(1, {.columns = 1, .rows = 1, .layers = 5});
  EXPECT_EQ(tower.row_count(), 5 * 4 * 3);
  const StepProblem smooth = make_pile(1, {.columns = 1, .rows = 1, .layers = 5, .mu = 0});
  EXPECT_EQ(smooth.row_count(), 5 * 4);
  const StepProblem open = make_chain(1, {.links = 20});
  EXPECT_EQ(open.row_count(), 20 * 3);
  const StepProblem ring = make_chain(1, {.links = 20, .extra_joints = 4, .hinges = true, .closed = true});
  EXPECT_EQ(ring.row_count(), 21 * 5 + 4 * 3);
  const StepProblem doubled = make_chain(1, {.links = 21, .doubled = true});
  EXPECT_EQ(doubled.row_count(), 21 * 3 + 2 * 3);
}

// A common translation of all bodies moves no joint between them.
TEST(StructureTest, JointRowsDoNotSeeACommonTranslation) {
  StepProblem ring = make_chain(3, {.links = 12, .hinges = true, .closed = true});
  for (int r = 5; r < ring.row_count(); ++r) {  // row 0..4 hold the first link to the world
    double along[6] = {};
    for (int k = 0; k < 12; ++k) along[k % 6] += ring.jacobian[12 * r + k];
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(along[k], 0, 1e-15) << "row " << r;
  }
}

TEST(PartsTest, AreNumberedFromZeroWithoutGaps) {
  SeededRandom random(1);
  for (int bodies = 1; bodies <= 30; ++bodies) {
    for (int parts = 1; parts <= bodies; ++parts) {
      for (const std::vector<int>& part_of_body :
           {sliced_parts(bodies, parts), random_parts(random, bodies, parts)}) {
        ASSERT_EQ(std::ssize(part_of_body), bodies);
        for (int part = 0; part < parts; ++part) {
          EXPECT_GE(std::count(part_of_body.begin(), part_of_body.end(), part), 1);
        }
        EXPECT_EQ(*std::max_element(part_of_body.begin(), part_of_body.end()), parts - 1);
      }
    }
  }
}

TEST(PartsTest, CutRowsAreThoseBetweenParts) {
  const StepProblem tower = make_pile(1, {.columns = 1, .rows = 1, .layers = 6});
  EXPECT_EQ(count_cut_rows(tower, single_part(6)), 0);
  EXPECT_EQ(count_cut_rows(tower, sliced_parts(6, 2)), 12);
  EXPECT_EQ(count_cut_rows(tower, own_parts(6)), 5 * 12);
}

}  // namespace
}  // namespace cleave
