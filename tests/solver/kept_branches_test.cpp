// A factorisation that keeps the branches, or the parts, in which no weight has changed gives the bytes of a
// whole one.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "solver/kernels/kernel.h"
#include "solver/registry.h"
#include "tests/solver/kernel_by_name.h"
#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

std::vector<std::string> names_of_kernels_that_keep() {
  return {"monolithic", "schur-bodies", "schur-nested", "schur-rows"};
}

class KeptBranchesTest : public testing::TestWithParam<std::string> {
 protected:
  KeptBranchesTest() {
    step_.prepare(problem_);
    kernel_ = make_kernel();
    for (int r = 0; r < problem_.row_count(); ++r) d_.push_back(r % 3 == 0 ? 0 : 1 / problem_.compliance[r]);
  }

  std::unique_ptr<Kernel> make_kernel() {
    auto kernel = cleave::make_kernel(GetParam());
    kernel->analyze(step_, parts_, tasks_);
    return kernel;
  }

  std::vector<double> answer(Kernel& kernel) {
    const std::vector<double> f_v(6 * problem_.body_count(), 0.25), f_r(problem_.row_count(), 0.5);
    std::vector<double> dv(f_v.size()), dlambda(f_r.size());
    kernel.solve(f_v, f_r, dv, dlambda, tasks_);
    dv.insert(dv.end(), dlambda.begin(), dlambda.end());
    return dv;
  }

  // Factors d_ with the kernel that has factored before and with a new one. The share of the work that was
  // done.
  double factor_and_compare(std::span<const WeightBlock> blocks = {}) {
    const auto fresh = make_kernel();
    EXPECT_TRUE(kernel_->factor({d_, blocks}, tasks_));
    EXPECT_TRUE(fresh->factor({d_, blocks}, tasks_));
    EXPECT_EQ(answer(*kernel_), answer(*fresh));
    const double whole = fresh->local_mflop() + fresh->interface_mflop();
    EXPECT_NEAR(fresh->done_mflop(), whole, 1e-9 * whole);
    return kernel_->done_mflop() / whole;
  }

  // The share of the work that is done whatever stays: the dense interface of schur-rows.
  double share_of_every_factorisation() {
    if (GetParam() != "schur-rows") return 0;
    return kernel_->interface_mflop() / (kernel_->interface_mflop() + kernel_->local_mflop());
  }

  void flip(int row) { d_[row] = d_[row] > 0 ? 0 : 1 / problem_.compliance[row]; }

  StageClock clock_;
  ParallelTasks tasks_{clock_, 2};
  const StepProblem problem_ = make_pile(7, {.columns = 6, .rows = 6, .layers = 3});
  const std::vector<int> part_of_body_ = sliced_parts(problem_.body_count(), 12);
  const Parts parts_ = part_of_body_;
  PreparedStep step_;
  std::unique_ptr<Kernel> kernel_;
  std::vector<double> d_;
};

TEST_P(KeptBranchesTest, GiveTheBytesOfAWholeFactorisation) {
  EXPECT_NEAR(factor_and_compare(), 1, 1e-9);
  std::mt19937 random(5);
  double least = 1;
  for (int k = 0; k < 60; ++k) {
    for (int flips = 1 + k % 3; flips > 0; --flips) flip(static_cast<int>(random() % d_.size()));
    least = std::min(least, factor_and_compare());
  }
  const double always = share_of_every_factorisation();
  EXPECT_LT(least, always + 0.8 * (1 - always));
}

TEST_P(KeptBranchesTest, AreAllWhereNothingChanges) {
  factor_and_compare();
  EXPECT_NEAR(factor_and_compare(), share_of_every_factorisation(), 1e-12);
}

// A solver does not bind its kernel again where the bodies of all rows are those of the step before.
TEST_P(KeptBranchesTest, AreNoneOfOtherNumbersOnTheSamePattern) {
  factor_and_compare();
  StepProblem heavier = problem_;
  for (double& mass : heavier.mass) mass *= 2;
  step_.prepare(heavier);
  EXPECT_NEAR(factor_and_compare(), 1, 1e-9);
}

TEST_P(KeptBranchesTest, AreNoneAfterAFailure) {
  factor_and_compare();
  const std::vector<double> good = d_;
  d_[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(kernel_->factor(d_, tasks_));
  d_ = good;
  EXPECT_NEAR(factor_and_compare(), 1, 1e-9);
}

TEST_P(KeptBranchesTest, AreNoneOfAnotherStepOrAnotherBasis) {
  factor_and_compare();
  ASSERT_TRUE(kernel_->rebind(step_, parts_, tasks_));
  EXPECT_NEAR(factor_and_compare(), 1, 1e-9);
  std::vector<WeightBlock> blocks(1);
  blocks[0].basis = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  factor_and_compare(blocks);
  blocks[0].basis = {0, 1, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_NEAR(factor_and_compare(blocks), 1, 1e-9);
  EXPECT_NEAR(factor_and_compare(), 1, 1e-9);
}

// The weights are the same numbers, but no longer along the rows.
TEST_P(KeptBranchesTest, AreNoneOfTheFirstBasis) {
  factor_and_compare();
  std::vector<WeightBlock> blocks(1);
  blocks[0].basis = {0, 1, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_NEAR(factor_and_compare(blocks), 1, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Kernels, KeptBranchesTest, testing::ValuesIn(names_of_kernels_that_keep()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace cleave
