// Sweeps in slabs: every group once, nothing side by side that shares a body, and the same numbers as a slow sweep in
// the same order, for any number of threads.
#include "solver/slab_sweeps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

StepProblem problem_of(int columns) {
  PileOptions options;
  options.columns = columns;
  options.layers = 4;
  return make_pile(7, options);
}

struct Sweeps {
  explicit Sweeps(const StepProblem& problem, int threads = 1)
      : clock(threads),
        tasks(clock, threads),
        impulse(problem.warm_impulse.begin(), problem.warm_impulse.end()) {
    step.prepare(problem, &tasks);
    impulse.resize(step.row_count(), 0.0);
    velocity.resize(6 * static_cast<std::size_t>(step.body_count()));
    step.velocity(impulse, velocity);
    sweeps.bind(step, tasks);
  }
  int run(int count) {
    sweeps.take_in(impulse, velocity, tasks);
    const int changed = sweeps.run(count, tasks);
    sweeps.give_out(impulse, velocity, tasks);
    return changed;
  }

  StageClock clock;
  ParallelTasks tasks;
  PreparedStep step;
  SlabSweeps sweeps;
  std::vector<double> impulse, velocity;
};

TEST(SlabSweepsTest, HoldEveryGroupOnceAndNoBodyTwiceInAColour) {
  for (const int columns : {1, 2, 9, 30}) {
    const StepProblem problem = problem_of(columns);
    const Sweeps all(problem);
    const SlabSweeps& sweeps = all.sweeps;
    std::set<int> seen;
    for (int set = 0; set < sweeps.set_count(); ++set) {
      for (int color = 0; color < sweeps.color_count(set); ++color) {
        std::set<int> taken;
        for (const int g : sweeps.groups_of(set, color)) {
          const RowGroup& group = all.step.groups()[g];
          EXPECT_TRUE(seen.insert(g).second);
          EXPECT_TRUE(taken.insert(group.body_a).second);
          EXPECT_TRUE(group.body_b < 0 || taken.insert(group.body_b).second);
        }
      }
    }
    EXPECT_EQ(seen.size(), all.step.groups().size());
    for (const RowGroup& group : all.step.groups()) {
      if (group.body_b < 0) continue;
      EXPECT_LE(std::abs(sweeps.slab_of_body()[group.body_a] - sweeps.slab_of_body()[group.body_b]), 1);
    }
  }
  const StepProblem large = problem_of(30);
  EXPECT_GE(Sweeps(large).sweeps.slab_count(), 3);
}

// Row by row, from the equations at the top of slab_sweeps.h.
void slow_sweep(Sweeps& s) {
  const StepProblem& p = s.step.problem();
  for (int set = 0; set < s.sweeps.set_count(); ++set) {
    for (int color = 0; color < s.sweeps.color_count(set); ++color) {
      for (const int g : s.sweeps.groups_of(set, color)) {
        const RowGroup& group = s.step.groups()[g];
        for (int r = group.first_row; r < group.first_row + group.row_count; ++r) {
          double w = p.compliance[r] * s.impulse[r] - p.rhs[r];
          const auto velocity = [&](int side) { return s.velocity.data() + 6 * p.row_body[2 * r + side]; };
          for (int side = 0; side < (group.body_b < 0 ? 1 : 2); ++side)
            for (int c = 0; c < 6; ++c) w += p.jacobian[12 * r + 6 * side + c] * velocity(side)[c];
          const double whole = SlabSweeps::kOverRelaxation * w / s.step.diagonal()[r];
          const double next = std::clamp(s.impulse[r] - whole, p.lower[r], p.upper[r]);
          for (int side = 0; side < (group.body_b < 0 ? 1 : 2); ++side)
            for (int c = 0; c < 6; ++c)
              velocity(side)[c] += s.step.mass_jacobian()[12 * r + 6 * side + c] * (next - s.impulse[r]);
          s.impulse[r] = next;
        }
      }
    }
  }
}

TEST(SlabSweepsTest, AreThoseOfASlowSweepInTheSameOrder) {
  for (const int columns : {1, 9, 30}) {
    const StepProblem problem = problem_of(columns);
    Sweeps fast(problem), slow(problem);
    fast.run(3);
    for (int sweep = 0; sweep < 3; ++sweep) slow_sweep(slow);
    const double scale = *std::ranges::max_element(slow.impulse) + 1;
    for (std::size_t r = 0; r < fast.impulse.size(); ++r)
      ASSERT_NEAR(fast.impulse[r], slow.impulse[r], 1e-4 * scale) << columns << " columns, row " << r;
    for (std::size_t c = 0; c < fast.velocity.size(); ++c)
      ASSERT_NEAR(fast.velocity[c], slow.velocity[c], 1e-4) << columns << " columns";
  }
}

// Where a row stands: at its lower bound, free, or at its upper one.
std::vector<int> sides(const Sweeps& s) {
  const StepProblem& p = s.step.problem();
  std::vector<int> sides;
  for (int r = 0; r < p.row_count(); ++r)
    sides.push_back(s.impulse[r] <= p.lower[r] ? -1 : s.impulse[r] >= p.upper[r] ? 1 : 0);
  return sides;
}

TEST(SlabSweepsTest, CountTheRowsThatChangeSides) {
  const StepProblem problem = problem_of(9);
  Sweeps s(problem);
  int most = 0;
  for (const int count : {1, 2, 5, 1}) {
    const std::vector<int> before = sides(s);
    const int told = s.run(count);
    const std::vector<int> after = sides(s);
    int changed = 0;
    for (std::size_t r = 0; r < before.size(); ++r) changed += before[r] != after[r];
    EXPECT_EQ(told, changed);
    most = std::max(most, changed);
  }
  EXPECT_GT(most, 50);
}

TEST(SlabSweepsTest, GoOnWhereTheRunBeforeEnded) {
  const StepProblem problem = problem_of(9);
  Sweeps at_once(problem), in_turns(problem);
  at_once.run(5);
  in_turns.sweeps.take_in(in_turns.impulse, in_turns.velocity, in_turns.tasks);
  for (const int count : {2, 1, 2}) in_turns.sweeps.run(count, in_turns.tasks);
  in_turns.sweeps.give_out(in_turns.impulse, in_turns.velocity, in_turns.tasks);
  EXPECT_EQ(in_turns.impulse, at_once.impulse);
  EXPECT_EQ(in_turns.velocity, at_once.velocity);
}

TEST(SlabSweepsTest, GiveTheSameBytesOnAnyNumberOfThreadsInAnyOrder) {
  const StepProblem problem = problem_of(30);
  Sweeps one(problem);
  one.run(SlabSweeps::kMostSweeps);
  for (const int threads : {1, 2, 3, 7}) {
    for (const int seed : {0, 1, 2}) {
      Sweeps many(problem, threads);
      WorkerTeam::shared(threads).shuffle(seed);
      many.run(SlabSweeps::kMostSweeps);
      WorkerTeam::shared(threads).shuffle(0);
      EXPECT_EQ(many.impulse, one.impulse) << threads << " threads, seed " << seed;
      EXPECT_EQ(many.velocity, one.velocity) << threads << " threads, seed " << seed;
    }
  }
}

}  // namespace
}  // namespace cleave
