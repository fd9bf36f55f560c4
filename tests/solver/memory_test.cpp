// Memory of a factorisation: what is predicted before it is allocated is what it takes, and what is above the
// limit is refused before it takes any.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "solver/block_symbolic.h"
#include "solver/kernels/kernel.h"
#include "solver/linear/dense_cholesky.h"
#include "solver/memory_count.h"
#include "solver/registry.h"
#include "tests/solver/allocation_counter.h"
#include "tests/solver/kernel_by_name.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

// A prediction is at most so many times what is taken. Lists that grow as they are filled are counted twice;
// of the oracle, what a product takes for a moment is not seen here.
constexpr double kMostOverTaken = 1.5, kMostOverTakenDense = 2;

std::vector<std::string> kernel_names() {
  std::vector<std::string> names;
  for (const KernelRow& row : kernel_table())
    if (std::string_view(row.name) != "auto") names.push_back(row.name);
  return names;
}

class MemoryTest : public testing::TestWithParam<std::string> {
 protected:
  void holds_what_is_taken(const StepProblem& problem, const std::vector<int>& parts);
};

long bytes_of_malloc() {
  const struct mallinfo2 info = ::mallinfo2();
  return static_cast<long>(info.uordblks + info.hblkhd);
}

struct Taken {
  long peak_bytes = 0;         // of operator new
  long malloc_bytes = 0;       // held at the end
  std::uint64_t needed_bytes;  // as predicted
};

// The second factorisation and solve are those of a kernel whose scratch is there.
Taken take(const std::string& name, const StepProblem& problem, const std::vector<int>& parts) {
  StageClock clock(2);
  clock.start();
  ParallelTasks tasks(clock, 2);
  PreparedStep step;
  step.prepare(problem, &tasks);
  const std::vector<double> d(problem.row_count(), 1e3), f_v(problem.free_velocity.size(), 1.0),
      f_r(problem.row_count(), 1.0);
  std::vector<double> dv(f_v.size()), dlambda(f_r.size());
  const long before = bytes_of_malloc();
  const AllocationCount count;
  const std::unique_ptr<Kernel> kernel = make_kernel(name);
  kernel->analyze(step, parts, tasks);
  for (int k = 0; k < 2; ++k) {
    EXPECT_TRUE(kernel->factor(d, tasks));
    kernel->solve(f_v, f_r, dv, dlambda, tasks);
  }
  return {count.peak_bytes(), bytes_of_malloc() - before, tasks.memory().needed_bytes()};
}

void MemoryTest::holds_what_is_taken(const StepProblem& problem, const std::vector<int>& parts) {
  const bool is_dense = GetParam() == "dense";
  const Taken taken = take(GetParam(), problem, parts);
  const auto bytes = static_cast<double>(is_dense ? taken.malloc_bytes : taken.peak_bytes);
  const auto needed = static_cast<double>(taken.needed_bytes);
  EXPECT_GE(needed, bytes) << problem.row_count() << " rows";
  EXPECT_LE(needed, (is_dense ? kMostOverTakenDense : kMostOverTaken) * bytes)
      << problem.row_count() << " rows";
}

TEST_P(MemoryTest, PredictionHoldsWhatIsTaken) {
  const StepProblem pile = make_pile(3, {.columns = 6, .rows = 6, .layers = 4});
  holds_what_is_taken(pile, sliced_parts(pile.body_count(), 6));
  const StepProblem slab = make_pile(3, {.columns = 12, .rows = 12, .layers = 2, .mu = 0});
  holds_what_is_taken(slab, sliced_parts(slab.body_count(), 3));
}

class SecondMemoryTest : public MemoryTest {};

// The next pattern is larger, and the factor of the one before is not kept beside the new one.
TEST_P(SecondMemoryTest, PredictionHoldsForALargerProblem) {
  const StepProblem small = make_pile(3, {.columns = 5, .rows = 5, .layers = 4}),
                    large = make_pile(3, {.columns = 6, .rows = 6, .layers = 4});
  StageClock clock(2);
  clock.start();
  ParallelTasks tasks(clock, 2);
  PreparedStep first, second;
  first.prepare(small, &tasks);
  second.prepare(large, &tasks);
  const std::vector<double> of_first(small.row_count(), 1e3), of_second(large.row_count(), 1e3);
  const std::vector<int> parts_of_first = sliced_parts(small.body_count(), 4),
                         parts_of_second = sliced_parts(large.body_count(), 4);
  const AllocationCount count;
  const std::unique_ptr<Kernel> kernel = make_kernel(GetParam());
  kernel->analyze(first, parts_of_first, tasks);
  EXPECT_TRUE(kernel->factor(of_first, tasks));
  kernel->analyze(second, parts_of_second, tasks);
  EXPECT_TRUE(kernel->factor(of_second, tasks));
  EXPECT_GE(static_cast<long>(1.1 * static_cast<double>(tasks.memory().needed_bytes())), count.peak_bytes());
}

TEST_P(MemoryTest, RefusalTakesNothingLarge) {
  const StepProblem pile = make_pile(3, {.columns = 8, .rows = 8, .layers = 6});
  const std::vector<int> parts = sliced_parts(pile.body_count(), 6);
  StageClock clock(2);
  clock.start();
  ParallelTasks free(clock, 2);
  PreparedStep step;
  step.prepare(pile, &free);
  make_kernel(GetParam())->analyze(step, parts, free);
  const std::uint64_t needed = free.memory().needed_bytes();
  ParallelTasks tight(clock, 2, nullptr, needed / 20);
  const std::unique_ptr<Kernel> kernel = make_kernel(GetParam());
  const AllocationCount count;
  EXPECT_THROW(kernel->analyze(step, parts, tight), MemoryRefused);
  EXPECT_LE(count.peak_bytes(), static_cast<long>(needed / 10));
  EXPECT_GT(tight.memory().needed_bytes(), needed / 20);
  EXPECT_LE(tight.memory().needed_bytes(), needed);
}

// A byte decides; and a solver that refused solves the next problem as a new one does.
TEST_P(MemoryTest, LimitDecidesTheStatus) {
  const StepProblem pile = make_pile(3, {.columns = 4, .rows = 4, .layers = 3}), few = make_pile(3, {});
  const std::vector<int> parts = sliced_parts(pile.body_count(), 4),
                         parts_of_few = sliced_parts(few.body_count(), 2);
  const std::string name = "pivot:" + GetParam();
  Solution expected = cold_start(pile);
  const SolveSummary unlimited = make_step_solver(name)->solve(pile, parts, expected);
  ASSERT_TRUE(is_exact(pile, unlimited, expected));
  const auto needed = static_cast<std::uint64_t>(std::llround(1e6 * unlimited.factor_predicted_mb));
  ASSERT_GT(needed, 100'000u);

  const SolveOptions enough{.memory_limit_bytes = needed};
  Solution found = cold_start(pile);
  EXPECT_TRUE(is_exact(pile, make_step_solver(name, enough)->solve(pile, parts, found), found));
  EXPECT_TRUE(same_bytes(found.impulse, expected.impulse));

  for (const int threads : {1, 2}) {  // on two, another than the caller's may be the one that is refused
    const auto solver = make_step_solver(name, {.threads = threads, .memory_limit_bytes = needed - 1});
    const SolveSummary refused = solver->solve(pile, parts, found);
    EXPECT_EQ(refused.status, SolveStatus::out_of_memory);
    EXPECT_TRUE(refused.message.starts_with("the factorisation needs ")) << refused.message;
    EXPECT_NE(refused.message.find(", the limit is "), std::string::npos) << refused.message;
    EXPECT_GT(refused.factor_predicted_mb, 0);
    Solution next = cold_start(few);
    EXPECT_TRUE(is_exact(few, solver->solve(few, parts_of_few, next), next));
  }
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

// Eigen's memory is not seen at its peak.
std::vector<std::string> names_but_dense() {
  std::vector<std::string> names = kernel_names();
  std::erase(names, "dense");
  return names;
}

INSTANTIATE_TEST_SUITE_P(Kernels, MemoryTest, testing::ValuesIn(kernel_names()), test_name);
INSTANTIATE_TEST_SUITE_P(Kernels, SecondMemoryTest, testing::ValuesIn(names_but_dense()), test_name);

TEST(MemoryCountTest, StaysAtTheGreatestNumber) {
  MemoryCount most;
  most.add<double>(1ull << 61);
  EXPECT_EQ(most.bytes(), kNoMemoryLimit);
  MemoryCount sum;
  sum.add<char>(kNoMemoryLimit - 5);
  EXPECT_EQ(sum.bytes(), kNoMemoryLimit - 5);
  sum.add<char>(6);
  EXPECT_EQ(sum.bytes(), kNoMemoryLimit);
  MemoryCount square;
  square.add<double>(1ull << 40, 1ull << 40);
  EXPECT_EQ(square.bytes(), kNoMemoryLimit);
}

TEST(MemoryCountTest, WhatIsBeyondCountingIsRefusedWithoutALimitToo) {
  MemoryCount memory;
  memory.add<char>(kNoMemoryLimit - 1);
  EXPECT_NO_THROW(MemoryBudget().request(memory));
  memory.add<char>(1);
  EXPECT_THROW(MemoryBudget().request(memory), MemoryRefused);
}

TEST(LemkeMemory, LimitDecidesTheStatus) {
  const StepProblem pile = make_pile(3, {.columns = 2, .rows = 2, .layers = 2});
  Solution solution = cold_start(pile);
  const SolveSummary enough = make_step_solver("lemke")->solve(pile, {}, solution);
  ASSERT_EQ(enough.status, SolveStatus::ok) << enough.message;
  const auto needed = static_cast<std::uint64_t>(std::llround(1e6 * enough.factor_predicted_mb));
  const SolveOptions tight{.memory_limit_bytes = needed - 1};
  const SolveSummary refused = make_step_solver("lemke", tight)->solve(pile, {}, solution);
  EXPECT_EQ(refused.status, SolveStatus::out_of_memory);
  EXPECT_TRUE(refused.message.starts_with("the factorisation needs ")) << refused.message;
}

TEST(MemoryCountTest, MessageNamesNeedAndLimitInTheirUnits) {
  EXPECT_STREQ(MemoryRefused(12'340'000'000, true, 8'000'000'000).what(),
               "the factorisation needs 12.4 GB, the limit is 8.0 GB");
  EXPECT_STREQ(MemoryRefused(8'000'000'001, true, 8'000'000'000).what(),
               "the factorisation needs 8.1 GB, the limit is 8.0 GB");
  EXPECT_STREQ(MemoryRefused(2'500'000, false, 100'000).what(),
               "the factorisation needs more than 2.5 MB, the limit is 100.0 kB");
}

// Of the cut rows of a silo of 10 000 bodies, and of more than can be numbered.
TEST(MemoryCountTest, DenseInterfacesAreCountedIn64Bits) {
  MemoryCount silo;
  DenseCholesky::count(117'000, silo);
  EXPECT_GT(silo.bytes(), 54'000'000'000u);
  EXPECT_LT(silo.bytes(), 90'000'000'000u);
  MemoryCount all;
  DenseCholesky::count(2'400'000, all);
  EXPECT_EQ(all.bytes(), kNoMemoryLimit);
}

// 65 bodies each of which touches all others: 65 * 66 / 2 blocks.
TEST(MemoryCountTest, SymbolicAnalysisEndsAtItsMostBlocks) {
  std::vector<std::pair<int, int>> edges;
  for (int a = 0; a < 65; ++a)
    for (int b = 0; b < a; ++b) edges.emplace_back(a, b);
  BlockSymbolic symbolic;
  EXPECT_TRUE(symbolic.analyze(65, edges, {}, 1, 2145));
  EXPECT_EQ(symbolic.block_count(), 2145);
  EXPECT_FALSE(symbolic.analyze(65, edges, {}, 1, 1000));
  EXPECT_GT(symbolic.block_count(), 1000);
  EXPECT_LE(symbolic.block_count(), 1065);
}

}  // namespace
}  // namespace cleave
