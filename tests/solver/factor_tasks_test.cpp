// Assembly and factorisation, large fronts in tiles: the factor that a front has as a whole, and the same
// bytes however many threads there are and in whatever order tasks that are ready come.
#include "solver/factor_tasks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "solver/body_system.h"
#include "solver/front_tiles.h"
#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

class FactorTasksTest : public testing::Test {
 protected:
  explicit FactorTasksTest(StepProblem problem = make_pile(11, {.columns = 7, .rows = 7, .layers = 7}))
      : problem_(std::move(problem)) {
    step_.prepare(problem_);
    matrix_.analyze_whole(step_, {}, 1, BlockSymbolic::kAnyBlocks);
    matrix_.allocate();
    system_.bind(step_, symbolic().position_of_node());
    for (int r = 0; r < problem_.row_count(); ++r) d_.push_back(r % 5 == 0 ? 0 : 1 / problem_.compliance[r]);
    system_.set({d_, {}});
    std::vector<int> branches(matrix_.branch_count());
    std::iota(branches.begin(), branches.end(), 0);
    factor_.list(symbolic(), branches);
  }
  const BlockSymbolic& symbolic() { return matrix_.cholesky().symbolic(); }
  std::vector<double> panels() {
    return {matrix_.cholesky().panels(), matrix_.cholesky().panels() + symbolic().factor_size()};
  }

  // The flags of all branches.
  std::vector<char> run(ParallelTasks& tasks) {
    std::vector<char> factored(matrix_.branch_count(), 1);
    factor_.run(Stage::factor_local, system_.rows(), matrix_, std::vector<char>(matrix_.branch_count(), 1),
                factored, tasks);
    return factored;
  }

  const StepProblem problem_;
  std::vector<double> d_;
  PreparedStep step_;
  BlockMatrix matrix_;
  BodySystem system_;
  FactorTasks factor_;
};

TEST_F(FactorTasksTest, GiveTheFactorOfWholeFronts) {
  matrix_.assemble(system_.rows());
  ASSERT_TRUE(matrix_.factor());
  const std::vector<double> whole = panels();
  StageClock clock;
  ParallelTasks tasks(clock, 1);
  EXPECT_EQ(std::ranges::count(run(tasks), 0), 0);
  EXPECT_GT(factor_.task_count(), 2 * matrix_.branch_count() + 100);
  const double largest = *std::ranges::max_element(whole);
  const std::vector<double> tiled = panels();
  for (std::size_t k = 0; k < whole.size(); ++k) ASSERT_NEAR(tiled[k], whole[k], 1e-12 * largest) << k;
}

TEST_F(FactorTasksTest, TellAssemblyApart) {
  for (const int threads : {1, 2, 3}) {
    StageClock clock(threads);
    ParallelTasks tasks(clock, threads);
    clock.start();
    run(tasks);
    const StageTimes times = clock.stop();
    const double assemble_ms = times.stage_ms[static_cast<std::size_t>(Stage::assemble)];
    const double factor_ms = times.stage_ms[static_cast<std::size_t>(Stage::factor_local)];
    EXPECT_GT(assemble_ms, 0) << threads;
    EXPECT_GT(factor_ms, 0) << threads;
    EXPECT_LE(assemble_ms + factor_ms, times.total_ms * (1 + 1e-9)) << threads;
  }
}

TEST_F(FactorTasksTest, CountAsTheStageThatTheyAreAPartOf) {
  for (const int threads : {1, 2}) {
    StageClock clock(threads);
    ParallelTasks tasks(clock, threads);
    clock.start();
    {
      const StageTimer timer(clock, Stage::refine);
      run(tasks);
    }
    const auto ms = clock.stop().stage_ms;
    EXPECT_GT(ms[static_cast<std::size_t>(Stage::refine)], 0);
    for (const Stage stage : {Stage::assemble, Stage::factor_local})
      EXPECT_EQ(ms[static_cast<std::size_t>(stage)], 0) << threads;
  }
}

TEST_F(FactorTasksTest, GiveTheSameBytesInAnyOrder) {
  StageClock clock(2);
  std::vector<double> first;
  for (const int threads : {1, 2, 3, 7}) {
    for (const std::uint64_t seed : {0, 1, 2, 3}) {
      WorkerTeam::shared(threads).shuffle(seed);
      ParallelTasks tasks(clock, threads);
      EXPECT_EQ(std::ranges::count(run(tasks), 0), 0);
      WorkerTeam::shared(threads).shuffle(0);
      if (first.empty()) first = panels();
      EXPECT_EQ(panels(), first) << threads << " threads, order " << seed;
    }
  }
}

// So many bodies joined at random that their last front is updated by several steps at once.
class LargestFrontTest : public FactorTasksTest {
 protected:
  LargestFrontTest() : FactorTasksTest(make_chain(5, {.links = 480, .extra_joints = 12000, .cfm = 1e-2})) {}
};

TEST_F(LargestFrontTest, HasTheFactorOfTheWholeAndTheSameBytesInAnyOrder) {
  const auto joins_steps = [](const Supernode& s) { return FrontStrips(s).joined_steps() > 1; };
  ASSERT_TRUE(std::ranges::any_of(symbolic().supernodes(), joins_steps));
  matrix_.assemble(system_.rows());
  ASSERT_TRUE(matrix_.factor());
  const std::vector<double> whole = panels();
  const double largest = *std::ranges::max_element(whole);
  StageClock clock(2);
  std::vector<double> first;
  for (const int threads : {1, 2, 3}) {
    WorkerTeam::shared(threads).shuffle(threads);
    ParallelTasks tasks(clock, threads);
    EXPECT_EQ(std::ranges::count(run(tasks), 0), 0);
    WorkerTeam::shared(threads).shuffle(0);
    if (first.empty()) first = panels();
    EXPECT_EQ(panels(), first) << threads << " threads";
  }
  for (std::size_t k = 0; k < whole.size(); ++k) ASSERT_NEAR(first[k], whole[k], 1e-12 * largest) << k;
}

// The front with the bad pivot and what is above it, and nothing else.
TEST_F(FactorTasksTest, NameTheFrontOfAPivotThatIsNotPositive) {
  StageClock clock(2);
  const auto branches = symbolic().branches();
  const int last = matrix_.branch_count() - 1;
  const auto tiled = std::ranges::find_if(branches, [&](const Branch& branch) {
    return branch.parent >= 0 && branch.first == branch.last &&
           symbolic().supernodes()[branch.last].width > 8 &&
           symbolic().supernodes()[branch.last].flops() > 5e6;
  });
  ASSERT_NE(tiled, branches.end());
  const Supernode& s = symbolic().supernodes()[tiled->last];
  // A row that pulls where it should hold, of the front's last body and one that is eliminated later or none.
  const auto position = [&](int body) {
    return body < 0 ? symbolic().node_count() : symbolic().position_of_node()[body];
  };
  const auto last_body = std::ranges::find_if(step_.groups(), [&](const RowGroup& group) {
    return std::min(position(group.body_a), position(group.body_b)) == s.first_position + s.width - 1;
  });
  ASSERT_NE(last_body, step_.groups().end());
  d_[last_body->first_row] = -1e12;
  system_.set({d_, {}});
  for (const int threads : {1, 2}) {
    ParallelTasks tasks(clock, threads);
    const std::vector<char> factored = run(tasks);
    for (int b = 0, bad = static_cast<int>(tiled - branches.begin()); b <= last; ++b) {
      EXPECT_EQ(factored[b], b != bad) << b;
      if (b == bad) bad = branches[b].parent;
    }
  }
}

}  // namespace
}  // namespace cleave
