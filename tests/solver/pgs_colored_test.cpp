// Colours of groups of rows against a slow twin, and the baseline that sweeps through them.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "solver/group_coloring.h"
#include "solver/registry.h"
#include "solver/residual.h"
#include "tests/solver/allocation_counter.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/seeded_random.h"

namespace cleave {
namespace {

bool share_body(const RowGroup& a, const RowGroup& b) {
  return a.body_a == b.body_a || a.body_a == b.body_b ||
         (a.body_b >= 0 && (a.body_b == b.body_a || a.body_b == b.body_b));
}

std::vector<RowGroup> random_groups(SeededRandom& random, int bodies) {
  std::vector<RowGroup> groups(random.integer(0, 60));
  for (RowGroup& g : groups) {
    g.body_a = random.integer(0, bodies - 1);
    g.body_b = random.integer(-1, bodies - 1);
    if (g.body_b == g.body_a) g.body_b = -1;
  }
  return groups;
}

// The least colour that no neighbour before has, group by group.
std::vector<int> slow_colors(const std::vector<RowGroup>& groups) {
  std::vector<int> colors;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::set<int> taken;
    for (std::size_t k = 0; k < g; ++k)
      if (share_body(groups[k], groups[g])) taken.insert(colors[k]);
    int color = 0;
    while (taken.contains(color)) ++color;
    colors.push_back(color);
  }
  return colors;
}

int largest_degree(const std::vector<RowGroup>& groups) {
  long most = 0;
  for (const RowGroup& g : groups)
    most = std::max(most,
                    std::ranges::count_if(groups, [&](const RowGroup& k) { return share_body(g, k); }) - 1);
  return static_cast<int>(most);
}

TEST(GroupColoringTest, IsValidGreedyAndSmallOnRandomGraphs) {
  GroupColoring coloring;
  for (int seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    SeededRandom random(seed);
    const int bodies = random.integer(1, 25);
    const std::vector<RowGroup> groups = random_groups(random, bodies);
    coloring.color(bodies, groups);
    std::vector<int> colors(groups.size(), -1);
    for (int color = 0; color < coloring.color_count(); ++color) {
      const auto members = coloring.groups_of(color);
      EXPECT_TRUE(std::ranges::is_sorted(members));
      for (const int g : members) {
        EXPECT_EQ(colors[g], -1);
        colors[g] = color;
        for (const int k : members) EXPECT_TRUE(k == g || !share_body(groups[g], groups[k]));
      }
    }
    EXPECT_EQ(colors, slow_colors(groups));
    EXPECT_LE(coloring.color_count(), groups.empty() ? 0 : largest_degree(groups) + 1);
  }
}

void expect_valid(const GroupColoring& coloring, const std::vector<RowGroup>& groups) {
  std::vector<int> colors(groups.size(), -1);
  for (int color = 0; color < coloring.color_count(); ++color) {
    EXPECT_TRUE(std::ranges::is_sorted(coloring.groups_of(color)));
    EXPECT_FALSE(coloring.groups_of(color).empty()) << color;
    for (const int g : coloring.groups_of(color)) EXPECT_EQ(std::exchange(colors[g], color), -1);
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    EXPECT_GE(colors[g], 0);
    for (std::size_t k = 0; k < g; ++k)
      EXPECT_TRUE(colors[g] != colors[k] || !share_body(groups[g], groups[k]));
  }
}

TEST(VivaceColoringTest, IsValidAndRepeatsItself) {
  GroupColoring coloring, again;
  int unlike = 0;
  for (int seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    SeededRandom random(seed);
    const int bodies = random.integer(1, 25);
    const std::vector<RowGroup> groups = random_groups(random, bodies);
    coloring.color_by_chance(bodies, groups, seed);
    expect_valid(coloring, groups);
    again.color_by_chance(bodies, groups, seed);
    ASSERT_EQ(again.color_count(), coloring.color_count());
    for (int color = 0; color < coloring.color_count(); ++color)
      EXPECT_TRUE(std::ranges::equal(again.groups_of(color), coloring.groups_of(color)));
    again.color_by_chance(bodies, groups, seed + 1);
    unlike += again.color_count() != coloring.color_count() ||
              (coloring.color_count() > 0 && !std::ranges::equal(again.groups_of(0), coloring.groups_of(0)));
    // A palette is of no more colours than neighbours over kShrinking, and one for each time that all of it
    // was taken: by as many neighbours.
    EXPECT_LE(coloring.color_count(), groups.empty() ? 0 : largest_degree(groups) + 1);
  }
  EXPECT_GT(unlike, 200);
}

// Between few bodies that all touch each other no two groups share a colour.
TEST(VivaceColoringTest, EveryGroupOfOneBodyHasItsOwn) {
  std::vector<RowGroup> star(9);
  for (int g = 0; g < 9; ++g) star[g] = {0, g + 1, g, 1};
  GroupColoring coloring;
  coloring.color_by_chance(10, star, 3);
  EXPECT_EQ(coloring.color_count(), 9);
  coloring.color_by_chance(0, {}, 3);
  EXPECT_EQ(coloring.color_count(), 0);
}

Solution solved(const StepProblem& problem, const std::string& solver, int threads) {
  SolveOptions options;
  options.threads = threads;
  Solution solution;
  solution.impulse = problem.warm_impulse;
  make_step_solver(solver, options)->solve(problem, Parts{}, solution);
  return solution;
}

TEST(PgsColoredTest, HasTheSameBytesForAnyNumberOfThreads) {
  PileOptions pile;
  pile.columns = 12;  // so that a colour is several tasks
  pile.layers = 4;
  const StepProblem problem = make_pile(3, pile);
  for (const char* solver : {"pgs-colored@sweeps=20", "pgs-colored@sweeps=20@coloring=vivace"}) {
    const Solution one = solved(problem, solver, 1);
    for (const int threads : {2, 3, 7}) {
      const Solution many = solved(problem, solver, threads);
      EXPECT_EQ(many.impulse, one.impulse) << solver << threads;
      EXPECT_EQ(many.velocity, one.velocity) << solver << threads;
    }
  }
  EXPECT_NE(solved(problem, "pgs-colored@sweeps=20@coloring=vivace@coloring-seed=2", 1).impulse,
            solved(problem, "pgs-colored@sweeps=20@coloring=vivace", 1).impulse);
}

TEST(PgsColoredTest, ComesToTheOracleOnSmallProblems) {
  for (int seed = 1; seed <= 10; ++seed) {
    const StepProblem problem =
        make_small_problem(seed, {.least_cfm = 1e-3, .most_cfm = 1e-2, .mass_ratio = 10});
    const char* coloring = seed % 2 == 0 ? "greedy" : "vivace";
    const Solution found = solved(problem, std::string("pgs-colored@sweeps=100000@coloring=") + coloring, 2),
                   oracle = solved(problem, "dense", 1);
    EXPECT_LE(judge(problem, found.impulse).residual_m_per_s, 1e-6) << seed;
    for (std::size_t i = 0; i < oracle.velocity.size(); ++i)
      EXPECT_NEAR(found.velocity[i], oracle.velocity[i], 1e-4) << seed;
  }
}

TEST(PgsColoredTest, SecondSolveAllocatesNothing) {
  const StepProblem problem = make_pile(7, {.cfm = 1e-1});  // soft: a message is allocated
  for (const auto& [threads, coloring] : {std::pair{1, "greedy"}, {2, "greedy"}, {2, "vivace"}}) {
    SolveOptions options;
    options.threads = threads;
    const auto solver =
        make_step_solver(std::string("pgs-colored@sweeps=2000@coloring=") + coloring, options);
    const Parts parts;
    Solution solution;
    solution.impulse = problem.warm_impulse;
    solver->solve(problem, parts, solution);
    solution.impulse = problem.warm_impulse;
    long count = 0;
    SolveSummary summary;
    {
      const AllocationCount allocations;
      summary = solver->solve(problem, parts, solution);
      count = allocations.count();
    }
    EXPECT_EQ(summary.status, SolveStatus::ok);
    EXPECT_EQ(summary.iterations, 2000);
    EXPECT_EQ(count, 0) << threads;
  }
}

}  // namespace
}  // namespace cleave
