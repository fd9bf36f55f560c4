// Bodies that are eliminated first because their columns last: which they are, and that these columns are
// made once.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "solver/kernels/kernel.h"
#include "solver/lasting_bodies.h"
#include "tests/solver/kernel_by_name.h"
#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

std::vector<char> lasting_bodies(const StepProblem& problem) {
  PreparedStep step;
  step.prepare(problem);
  std::vector<char> lasting;
  const bool any = find_lasting_bodies(step, lasting);
  EXPECT_EQ(any, std::ranges::count(lasting, 1) > 0);
  return lasting;
}

// A link that only just holds: it may come apart.
void bound_row(StepProblem& problem, int row) { problem.lower[row] = 0; }

TEST(LastingBodies, AreThoseOfRowsWithoutBoundsBetweenFew) {
  int lasting = 0, others = 0;
  for (int seed = 0; seed < 100; ++seed) {
    StepProblem problem = make_chain(seed, {.links = 12, .extra_joints = seed % 4, .closed = seed % 2 == 1});
    for (int k = 0; k < seed % 3; ++k) bound_row(problem, (17 * seed + 5 * k) % problem.row_count());
    const std::vector<char> found = lasting_bodies(problem);
    for (int body = 0; body < problem.body_count(); ++body) {
      std::multiset<int> neighbours;  // one of each run of rows
      bool is_bounded = false;
      for (int row = 0, last = -1; row < problem.row_count(); ++row) {
        const int a = problem.row_body[2 * row], b = problem.row_body[2 * row + 1];
        const int other = a == body ? b : b == body ? a : -1;
        if (other >= 0 && other != last) neighbours.insert(other);
        last = other;
        is_bounded = is_bounded || ((a == body || b == body) && problem.lower[row] == 0);
      }
      const bool expected = !is_bounded && !neighbours.empty() && neighbours.size() <= 2;
      EXPECT_EQ(found[body], expected ? 1 : 0) << "seed " << seed << " body " << body;
      (expected ? lasting : others) += 1;
    }
  }
  EXPECT_GT(lasting, 200);
  EXPECT_GT(others, 200);
}

TEST(LastingBodies, AreNotAmongContacts) {
  EXPECT_EQ(std::ranges::count(lasting_bodies(make_pile(1, {})), 1), 0);
}

class LastingColumnsTest : public testing::TestWithParam<std::string> {};

// Of a long chain with a joint in every ten that may come apart.
TEST_P(LastingColumnsTest, AreMadeOnce) {
  StepProblem problem = make_chain(3, {.links = 60});
  std::vector<int> bounded;
  for (int row = 15; row < problem.row_count(); row += 30) bounded.push_back(row);
  for (const int row : bounded) bound_row(problem, row);
  PreparedStep step;
  step.prepare(problem);
  StageClock clock;
  ParallelTasks tasks(clock, 2);
  const std::vector<int> part_of_body = single_part(problem.body_count());
  const auto kernel = make_kernel(GetParam());
  kernel->analyze(step, Parts(part_of_body), tasks);
  std::vector<double> d;
  for (const double compliance : problem.compliance) d.push_back(1 / compliance);
  ASSERT_TRUE(kernel->factor({d, {}}, tasks));
  const double whole = kernel->done_mflop();
  for (const int row : bounded) d[row] = 0;
  ASSERT_TRUE(kernel->factor({d, {}}, tasks));
  EXPECT_GT(kernel->done_mflop(), 0);
  EXPECT_LT(kernel->done_mflop(), 0.5 * whole);
}

INSTANTIATE_TEST_SUITE_P(Kernels, LastingColumnsTest,
                         testing::Values("monolithic", "schur-bodies", "schur-nested"), [](const auto& info) {
                           std::string name = info.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace cleave
