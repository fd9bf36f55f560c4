// Sweeps in slabs: every group once, nothing side by side that shares a body, and the same numbers as a slow
// sweep in the same order, for any number of threads.
#include "solver/slab_sweeps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "solver/registry.h"
#include "solver/residual.h"
#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

StepProblem problem_of(int columns) {
  PileOptions options;
  options.columns = columns;
  options.layers = 4;
  return make_pile(7, options);
}

// A plate that falls on so many rocks side by side, a row each.
StepProblem make_star(int rocks) {
  StepProblem problem;
  const int plate = append_body(problem, 10, {1, 1, 1}, {0, 0, -1, 0, 0, 0});
  for (int i = 0; i < rocks; ++i) {
    RowSpec row{.body_a = plate, .compliance = 1e-5, .lower = 0, .kind = RowKind::normal, .constraint = i};
    row.body_b = append_body(problem, 1, {1, 1, 1}, {});
    row.jacobian_a = {0, 0, 1, 0, 0, 0};
    row.jacobian_b = {0, 0, -1, 0, 0, 0};
    append_row(problem, row);
  }
  return problem;
}

constexpr int kNever = -1;  // settled

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
    const int changed = sweeps.run(count, kNever, tasks);
    sweeps.give_out(impulse, velocity, tasks);
    return changed;
  }

  StageClock clock;
  ParallelTasks tasks;
  PreparedStep step;
  SlabSweeps sweeps;
  std::vector<double> impulse, velocity;
};

// The groups of every octet, set after set.
std::vector<std::vector<int>> octets_of(const SlabSweeps& sweeps) {
  std::vector<std::vector<int>> octets;
  for (int set = 0; set < sweeps.slabs().set_count(); ++set) {
    const std::size_t begin = octets.size();
    octets.resize(begin + sweeps.octet_count(set));
    for (const int g : sweeps.groups_of_set(set)) octets[begin + sweeps.octet_of_group(g)].push_back(g);
  }
  return octets;
}

TEST(SlabSweepsTest, HoldEveryGroupOnceAndNoBodyTwiceInAnOctet) {
  for (const int columns : {1, 2, 9, 30}) {
    const StepProblem problem = problem_of(columns);
    const Sweeps all(problem);
    std::set<int> seen;
    for (const std::vector<int>& octet : octets_of(all.sweeps)) {
      std::set<int> taken;
      EXPECT_TRUE(!octet.empty() && octet.size() <= kOctetLanes) << octet.size();
      for (const int g : octet) {
        const RowGroup& group = all.step.groups()[g];
        EXPECT_TRUE(seen.insert(g).second);
        EXPECT_TRUE(taken.insert(group.body_a).second);
        EXPECT_TRUE(group.body_b < 0 || taken.insert(group.body_b).second);
      }
    }
    EXPECT_EQ(seen.size(), all.step.groups().size());
  }
}

TEST(SlabSweepsTest, FillTheirLanes) {
  const StepProblem problem = problem_of(30);
  const Sweeps all(problem);
  long rows = 0;
  for (const std::vector<int>& octet : octets_of(all.sweeps)) {
    int longest = 0;
    for (const int g : octet) longest = std::max(longest, all.step.groups()[g].row_count);
    rows += kOctetLanes * longest;
  }
  EXPECT_LE(2 * rows, 3 * problem.row_count());
}

// More groups on one body than are looked through at a time: each gets an octet of its own.
TEST(SlabSweepsTest, KeepTheGroupsOfOneBodyApart) {
  constexpr int kRocks = 100;
  const StepProblem problem = make_star(kRocks);
  Sweeps star(problem);
  EXPECT_EQ(octets_of(star.sweeps).size(), kRocks);
  star.run(1);
  EXPECT_GT(std::ranges::count_if(star.impulse, [](double impulse) { return impulse > 0; }), 0);
}

TEST(SlabSweepsTest, CutSlabsOverWhichNoPairReaches) {
  const StepProblem problem = problem_of(30);
  const Sweeps all(problem);
  const Slabs& slabs = all.sweeps.slabs();
  EXPECT_GE(slabs.count(), 3);
  for (const RowGroup& group : all.step.groups()) {
    if (group.body_b < 0) continue;
    EXPECT_LE(std::abs(slabs.of_body()[group.body_a] - slabs.of_body()[group.body_b]), 1);
  }
}

// Row by row, from the equations at the top of slab_sweeps.h.
void slow_group(Sweeps& s, const RowGroup& group) {
  const StepProblem& p = s.step.problem();
  const auto velocity = [&](int r, int side) { return s.velocity.data() + 6 * p.row_body[2 * r + side]; };
  for (int r = group.first_row; r < group.first_row + group.row_count; ++r) {
    double w = p.compliance[r] * s.impulse[r] - p.rhs[r];
    for (int side = 0; side < (group.body_b < 0 ? 1 : 2); ++side)
      for (int c = 0; c < 6; ++c) w += p.jacobian[12 * r + 6 * side + c] * velocity(r, side)[c];
    const double next = std::clamp(s.impulse[r] - w / s.step.diagonal()[r], p.lower[r], p.upper[r]);
    for (int side = 0; side < (group.body_b < 0 ? 1 : 2); ++side)
      for (int c = 0; c < 6; ++c)
        velocity(r, side)[c] += s.step.mass_jacobian()[12 * r + 6 * side + c] * (next - s.impulse[r]);
    s.impulse[r] = next;
  }
}

void slow_sweep(Sweeps& s) {
  for (const std::vector<int>& octet : octets_of(s.sweeps))
    for (const int g : octet) slow_group(s, s.step.groups()[g]);
}

double agreement(const std::vector<double>& next, const std::vector<double>& start,
                 const std::vector<double>& before) {
  double sum = 0;
  for (std::size_t i = 0; i < next.size(); ++i) sum += (next[i] - start[i]) * (next[i] - before[i]);
  return sum;
}

// x <- x + beta (x - before), before <- x
void slow_push(double beta, std::vector<double>& x, std::vector<double>& before) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double now = x[i];
    x[i] += beta * (now - before[i]);
    before[i] = now;
  }
}

// From the equations of sweep_momentum.h. Returns how often momentum began anew.
int slow_sweeps(Sweeps& s, int count) {
  std::vector<double> impulse = s.impulse, velocity = s.velocity;
  const double root = std::sqrt(std::min(1.0, s.step.least_relative_compliance()));
  const double most = std::min(0.8, (1 - root) / (1 + root));
  double t = 1;
  int restarts = 0;
  for (int sweep = 0; sweep < count; ++sweep) {
    const std::vector<double> start = s.impulse;
    slow_sweep(s);
    if (sweep == count - 1) break;
    const double next_t = (1 + std::sqrt(1 + 4 * t * t)) / 2;
    const bool goes_back = agreement(s.impulse, start, impulse) < 0;
    const double beta = goes_back ? 0 : std::min((t - 1) / next_t, most);
    t = goes_back ? 1 : next_t;
    restarts += goes_back;
    slow_push(beta, s.impulse, impulse);
    slow_push(beta, s.velocity, velocity);
  }
  return restarts;
}

// Returns how often momentum began anew.
int compare_with_slow(const StepProblem& problem, int sweeps, double tolerance) {
  Sweeps fast(problem), slow(problem);
  fast.sweeps.take_in(fast.impulse, fast.velocity, fast.tasks);
  for (int done = 0; done < sweeps; done += 4)
    fast.sweeps.run(std::min(4, sweeps - done), kNever, fast.tasks);
  fast.sweeps.give_out(fast.impulse, fast.velocity, fast.tasks);
  const int restarts = slow_sweeps(slow, sweeps);
  const double scale = *std::ranges::max_element(slow.impulse) + 1;
  for (std::size_t r = 0; r < fast.impulse.size(); ++r)
    EXPECT_NEAR(fast.impulse[r], slow.impulse[r], tolerance * scale) << sweeps << " sweeps, row " << r;
  for (std::size_t c = 0; c < fast.velocity.size(); ++c)
    EXPECT_NEAR(fast.velocity[c], slow.velocity[c], tolerance) << sweeps << " sweeps";
  return restarts;
}

TEST(SlabSweepsTest, AreThoseOfSlowSweepsInTheSameOrder) {
  for (const int columns : {1, 9, 30}) compare_with_slow(problem_of(columns), 18, 1e-4);
}

TEST(SlabSweepsTest, BeginMomentumAnewWhereSlowSweepsDo) {
  int restarts = 0;
  for (int sweeps = 1; sweeps < 20; ++sweeps) restarts += compare_with_slow(make_star(4), sweeps, 1e-5);
  EXPECT_GT(restarts, 0);
}

double squared_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

TEST(SlabSweepsTest, ComeNearerThanSweepsWithoutMomentum) {
  const StepProblem problem = problem_of(9);
  Solution exact;
  ASSERT_EQ(make_step_solver("exact")->solve(problem, {}, exact).status, SolveStatus::ok);
  Sweeps with(problem), without(problem);
  with.sweeps.take_in(with.impulse, with.velocity, with.tasks);
  for (int run = 0; run < 12; ++run) with.sweeps.run(5, kNever, with.tasks);
  with.sweeps.give_out(with.impulse, with.velocity, with.tasks);
  for (int sweep = 0; sweep < 60; ++sweep) slow_sweep(without);
  const std::vector<double> velocity = judge(problem, exact.impulse).velocity;
  EXPECT_LT(squared_distance(with.velocity, velocity), 0.3 * squared_distance(without.velocity, velocity));
}

float share_after(int sweeps, SweepMomentum momentum) {
  for (int sweep = 0; sweep < sweeps; ++sweep) momentum.end_sweep(1);
  return momentum.share();
}

TEST(SweepMomentumTest, GrowsToItsBound) {
  const SweepMomentum stiff(1e-6);
  EXPECT_EQ(share_after(0, stiff), 0);
  EXPECT_EQ(share_after(1, stiff), 0);  // of one sweep there is no change to go on with
  for (int sweeps = 1; sweeps < 20; ++sweeps)
    EXPECT_LE(share_after(sweeps, stiff), share_after(sweeps + 1, stiff));
  EXPECT_FLOAT_EQ(share_after(20, stiff), 0.8F);
  EXPECT_FLOAT_EQ(share_after(20, SweepMomentum(0.25)), 1.0F / 3);
  for (const double soft : {1.0, 2.0, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(share_after(20, SweepMomentum(soft)), 0) << soft;
}

TEST(SweepMomentumTest, BeginsAnewWhereASweepGoesBack) {
  for (const double back : {-1e-30, std::numeric_limits<double>::quiet_NaN()}) {
    SweepMomentum momentum(1e-6);
    for (int sweep = 0; sweep < 5; ++sweep) momentum.end_sweep(1);
    EXPECT_GT(momentum.share(), 0);
    momentum.end_sweep(back);
    EXPECT_EQ(momentum.share(), 0) << back;
    EXPECT_EQ(share_after(7, momentum), share_after(7, SweepMomentum(1e-6))) << back;
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

TEST(SlabSweepsTest, EndAtTheFirstLookAtWhichTheyHaveSettled) {
  const StepProblem problem = problem_of(9);
  Sweeps at_once(problem), in_turns(problem);
  const auto run = [](Sweeps& s, int sweeps, int settled) { return s.sweeps.run(sweeps, settled, s.tasks); };
  for (Sweeps* s : {&at_once, &in_turns}) s->sweeps.take_in(s->impulse, s->velocity, s->tasks);
  std::vector<int> counts;
  for (int look = 0; look < 3; ++look) counts.push_back(run(in_turns, SlabSweeps::kSweepsOfALook, kNever));
  ASSERT_GT(std::min(counts[0], counts[1]), counts[2]);
  EXPECT_EQ(run(at_once, SlabSweeps::kMostSweeps, counts[2]), counts[2]);
  for (Sweeps* s : {&at_once, &in_turns}) s->sweeps.give_out(s->impulse, s->velocity, s->tasks);
  EXPECT_EQ(at_once.impulse, in_turns.impulse);
  EXPECT_EQ(at_once.velocity, in_turns.velocity);
}

TEST(SlabSweepsTest, GoOnWhereTheRunBeforeEnded) {
  const StepProblem problem = problem_of(9);
  Sweeps at_once(problem), in_turns(problem);
  at_once.run(5);
  in_turns.sweeps.take_in(in_turns.impulse, in_turns.velocity, in_turns.tasks);
  for (const int count : {2, 1, 2}) in_turns.sweeps.run(count, kNever, in_turns.tasks);
  in_turns.sweeps.give_out(in_turns.impulse, in_turns.velocity, in_turns.tasks);
  EXPECT_EQ(in_turns.impulse, at_once.impulse);
  EXPECT_EQ(in_turns.velocity, at_once.velocity);
}

// The graph of a number of slabs is kept from one step to the next.
TEST(SlabSweepsTest, AreThoseOfNewOnesOnAnotherStep) {
  const StepProblem small = problem_of(9), large = problem_of(30);
  Sweeps kept(small);
  for (const StepProblem* problem : {&large, &small, &small, &large}) {
    Sweeps fresh(*problem);
    fresh.run(7);
    kept.step.prepare(*problem, &kept.tasks);
    kept.impulse.assign(kept.step.row_count(), 0.0);
    std::ranges::copy(problem->warm_impulse, kept.impulse.begin());
    kept.velocity.resize(6 * static_cast<std::size_t>(kept.step.body_count()));
    kept.step.velocity(kept.impulse, kept.velocity);
    kept.sweeps.bind(kept.step, kept.tasks);
    kept.run(7);
    EXPECT_EQ(kept.impulse, fresh.impulse);
  }
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
