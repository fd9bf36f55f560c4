// Orders of constraints against slow twins, and `pgs` in each of them.
#include "solver/baselines/constraint_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/solver/iterative_checks.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/seeded_random.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

constexpr OrderKind kOrders[] = {OrderKind::natural, OrderKind::random, OrderKind::height,
                                 OrderKind::propagation};
constexpr const char* kNames[] = {"natural", "random", "height", "propagation"};

// A pile on whose highest blocks chains hang, so that joints are reached before contacts are.
StepProblem pile_with_joints(int seed) {
  StepProblem problem = make_pile(seed, {.columns = 3, .rows = 2, .layers = 4, .cfm = 1e-2});
  SeededRandom random(seed);
  int constraint = *std::ranges::max_element(problem.row_constraint);
  for (int link = 0; link < 5; ++link) {
    const int body = append_body(problem, 1, {1, 1, 1}, {0, 0, -1, 0, 0, 0});
    const int other = random.integer(0, body - 1);
    ++constraint;
    for (int axis = 0; axis < 3; ++axis) {
      RowSpec row{.body_a = body, .body_b = other, .compliance = 1e-2, .constraint = constraint};
      row.jacobian_a[axis] = 1;
      row.jacobian_b[axis] = -1;
      row.point = {0, 0, random.uniform(0, 5)};
      append_row(problem, row);
    }
  }
  return problem;
}

// The constraint of each visit of one sweep. Rows of a constraint must be visited together and in their
// order.
std::vector<int> visited(const StepProblem& problem, std::span<const RowGroup> sweep) {
  std::vector<int> constraints;
  std::set<int> rows;
  int last = -1;
  for (const RowGroup& g : sweep) {
    for (int r = g.first_row; r < g.first_row + g.row_count; ++r) {
      EXPECT_TRUE(rows.insert(r).second) << "row " << r << " twice";
      EXPECT_EQ(g.body_a, problem.row_body[2 * r]);
      EXPECT_EQ(g.body_b, problem.row_body[2 * r + 1]);
      if (last >= 0 && problem.row_constraint[r] == problem.row_constraint[last]) {
        EXPECT_EQ(r, last + 1);
      } else {
        constraints.push_back(problem.row_constraint[r]);
      }
      last = r;
    }
  }
  EXPECT_EQ(static_cast<int>(rows.size()), problem.row_count());
  EXPECT_EQ(std::set(constraints.begin(), constraints.end()).size(), constraints.size());
  return constraints;
}

std::vector<int> order_of(const StepProblem& problem, OrderKind kind, int seed = 1) {
  PreparedStep step;
  step.prepare(problem);
  ConstraintOrder order(kind, seed);
  order.begin(step);
  return visited(problem, order.next(step));
}

// By relaxation until nothing changes: a constraint is one further than the least of those that it shares a
// body with.
std::map<int, int> slow_levels(const StepProblem& problem) {
  const int m = problem.row_count();
  std::vector<int> level(m, m + 1);
  for (int r = 0; r < m; ++r)
    if (problem.row_body[2 * r + 1] < 0 || problem.row_kind[r] == RowKind::bilateral) level[r] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (int r = 0; r < m; ++r) {
      for (int k = 0; k < m; ++k) {
        const auto has = [&](int body) {
          return body >= 0 && (body == problem.row_body[2 * k] || body == problem.row_body[2 * k + 1]);
        };
        if (!has(problem.row_body[2 * r]) && !has(problem.row_body[2 * r + 1])) continue;
        if (level[k] + 1 < level[r]) level[r] = level[k] + 1, changed = true;
      }
    }
  }
  std::map<int, int> levels;
  for (int r = 0; r < m; ++r) levels[problem.row_constraint[r]] = level[r];
  return levels;
}

TEST(ConstraintOrderTest, VisitsEveryConstraintOnceAndWhole) {
  for (int seed = 1; seed <= 20; ++seed) {
    const StepProblem problem = pile_with_joints(seed);
    std::vector<int> natural = order_of(problem, OrderKind::natural);
    std::ranges::sort(natural);
    for (const OrderKind kind : kOrders) {
      std::vector<int> sorted = order_of(problem, kind);
      std::ranges::sort(sorted);
      EXPECT_EQ(sorted, natural);
    }
  }
}

TEST(ConstraintOrderTest, HeightIsFromTheGroundUp) {
  const StepProblem problem = pile_with_joints(3);
  std::map<int, double> height;
  for (int r = problem.row_count() - 1; r >= 0; --r)
    height[problem.row_constraint[r]] = problem.contact_point[3 * r + 2];
  const std::vector<int> order = order_of(problem, OrderKind::height);
  EXPECT_NE(order, order_of(problem, OrderKind::natural));
  std::vector<int> slow = order_of(problem, OrderKind::natural);
  std::ranges::sort(slow);  // as the problem numbers them
  std::ranges::stable_sort(slow, {}, [&](int constraint) { return height[constraint]; });
  EXPECT_EQ(order, slow);
}

TEST(ConstraintOrderTest, PropagationIsByLevels) {
  for (int seed = 1; seed <= 5; ++seed) {
    StepProblem problem = pile_with_joints(seed);
    // Two bodies that nothing holds, in contact.
    const int a = append_body(problem, 1, {1, 1, 1}, {}), b = append_body(problem, 1, {1, 1, 1}, {});
    RowSpec contact{.body_a = a, .body_b = b, .compliance = 1, .lower = 0, .kind = RowKind::normal};
    contact.constraint = *std::ranges::max_element(problem.row_constraint) + 1;
    contact.jacobian_a[2] = 1, contact.jacobian_b[2] = -1;
    append_row(problem, contact);
    std::map<int, int> levels = slow_levels(problem);
    EXPECT_GT(std::ranges::count(levels, 2, &std::pair<const int, int>::second), 0);
    std::vector<int> slow;
    for (const auto& [constraint, level] : levels) slow.push_back(constraint);
    std::ranges::stable_sort(slow, {}, [&](int constraint) { return levels[constraint]; });
    EXPECT_EQ(order_of(problem, OrderKind::propagation), slow) << seed;
    EXPECT_EQ(slow.back(), contact.constraint);
  }
}

TEST(ConstraintOrderTest, RandomIsAnotherOrderEverySweepAndTheSameOfASeed) {
  const StepProblem problem = pile_with_joints(2);
  PreparedStep step;
  step.prepare(problem);
  ConstraintOrder order(OrderKind::random, 7);
  std::vector<std::vector<std::vector<int>>> first;
  for (int again = 0; again < 2; ++again) {
    order.begin(step);
    std::vector<std::vector<int>> sweeps;
    for (int sweep = 0; sweep < 4; ++sweep) sweeps.push_back(visited(problem, order.next(step)));
    EXPECT_EQ(std::set(sweeps.begin(), sweeps.end()).size(), 4u);
    first.push_back(std::move(sweeps));
  }
  EXPECT_EQ(first[0], first[1]);
  EXPECT_NE(order_of(problem, OrderKind::random, 8), first[0][0]);
}

class OrderedPgsTest : public testing::TestWithParam<int> {
 protected:
  static std::string solver(int sweeps) {
    return std::string("pgs@order=") + kNames[GetParam()] + "@sweeps=" + std::to_string(sweeps);
  }
};

// Row by row as the equations have it, in the order that ConstraintOrder gives.
TEST_P(OrderedPgsTest, SweepsInItsOrder) {
  const StepProblem problem = pile_with_joints(4);
  PreparedStep step;
  step.prepare(problem);
  ConstraintOrder order(kOrders[GetParam()], 1);
  order.begin(step);
  std::vector<double> impulse(problem.row_count(), 0), w(problem.row_count()),
      v(problem.free_velocity.size());
  for (int sweep = 0; sweep < 3; ++sweep) {
    for (const RowGroup& g : order.next(step)) {
      for (int r = g.first_row; r < g.first_row + g.row_count; ++r) {
        step.velocity(impulse, v);
        step.slack(v, impulse, w);
        impulse[r] = std::clamp(impulse[r] - w[r] / step.diagonal()[r], problem.lower[r], problem.upper[r]);
      }
    }
  }
  const Iterated found = iterate_by(solver(3), problem);
  for (int r = 0; r < problem.row_count(); ++r)
    EXPECT_NEAR(found.solution.impulse[r], impulse[r], 1e-9 * std::max(1.0, std::abs(impulse[r]))) << r;
}

TEST_P(OrderedPgsTest, ComesToTheOracle) {
  for (int seed = 0; seed < 20; ++seed) {
    const StepProblem problem =
        make_small_problem(seed, {.least_cfm = 1e-3, .most_cfm = 1e-1, .mass_ratio = 10});
    const Iterated found = iterate_by(solver(20000), problem), oracle = iterate_by("dense", problem);
    EXPECT_LE(judge(problem, found.solution.impulse).residual_m_per_s, 1e-6) << seed;
    EXPECT_TRUE(velocities_agree(problem, found.solution.velocity, oracle.solution.velocity, 1e-4));
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, OrderedPgsTest, testing::Range(0, 4),
                         [](const auto& info) { return kNames[info.param]; });

class UntilTest : public testing::TestWithParam<const char*> {};

TEST_P(UntilTest, EndsWhereTheResidualIsReached) {
  const StepProblem problem = make_pile(6, {.columns = 2, .rows = 2, .layers = 3, .cfm = 1e-2});
  const std::string solver = GetParam();
  int last = 0;
  for (const double until : {1e-1, 1e-3, 1e-6}) {
    const Iterated found = iterate_by(solver + "@sweeps=100000@until=" + std::to_string(until), problem);
    const ResidualReport judged = judge(problem, found.solution.impulse);
    PreparedStep step;
    step.prepare(problem);
    EXPECT_LE(judged.residual_m_per_s, until * step.velocity_scale() * (1 + 1e-9)) << until;
    EXPECT_GE(found.summary.iterations, last);
    EXPECT_LT(found.summary.iterations, 100000);
    last = found.summary.iterations;
    // An eighth of the sweeps earlier it was not yet reached.
    const Iterated before = iterate_by(solver + "@sweeps=" + std::to_string((last - 1) * 7 / 8), problem);
    EXPECT_GT(judge(problem, before.solution.impulse).residual_m_per_s,
              until * step.velocity_scale() * 0.999);
  }
  EXPECT_GT(last, 10);
}

TEST_P(UntilTest, SweepsAreABudgetToo) {
  const StepProblem problem = make_pile(6, {.columns = 2, .rows = 2, .layers = 3, .cfm = 1e-8});
  EXPECT_EQ(iterate_by(std::string(GetParam()) + "@sweeps=9@until=1e-12", problem).summary.iterations, 9);
}

TEST_P(UntilTest, NothingIsSweptWhereNothingIsWanting) {
  StepProblem problem = make_pile(6, {.columns = 2, .rows = 2, .layers = 3});
  std::ranges::fill(problem.free_velocity, 0.0);
  std::ranges::fill(problem.rhs, 0.0);
  EXPECT_EQ(iterate_by(std::string(GetParam()) + "@sweeps=9@until=1e-6", problem).summary.iterations, 0);
}

INSTANTIATE_TEST_SUITE_P(Baselines, UntilTest,
                         testing::Values("pgs", "pgs-colored", "pgs-parts", "apgd", "jacobi-split",
                                         "split-domains"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST(PgsPartsTest, OnePartIsPgsToTheByte) {
  const StepProblem problem = pile_with_joints(9);
  EXPECT_TRUE(same_bytes(iterate_by("pgs-parts@sweeps=7", problem, 1).solution.impulse,
                         iterate_by("pgs@sweeps=7", problem, 1).solution.impulse));
  EXPECT_FALSE(same_bytes(iterate_by("pgs-parts@sweeps=7", problem, 3).solution.impulse,
                          iterate_by("pgs@sweeps=7", problem, 3).solution.impulse));
}

}  // namespace
}  // namespace cleave
