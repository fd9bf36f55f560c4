// What is handed to a kernel's passes over the rows is done there: on every row once, weights and right-hand
// sides before they are read, and after increments are written; likewise where velocities follow from
// impulses. The answer has the bytes of one where all was done beforehand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver/carried_factor.h"
#include "solver/kernels/kernel.h"
#include "solver/solve_state.h"
#include "tests/solver/cone_contacts.h"
#include "tests/solver/dear_kernel.h"
#include "tests/solver/kernel_by_name.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/turned_boxes.h"

namespace cleave {
namespace {

constexpr double kUnwritten = std::numeric_limits<double>::quiet_NaN();

// A kernel of the table, or "carried" or "wrongly carried" one: with a wrong factor conjugate gradients give
// up, and the system is factored.
std::unique_ptr<Kernel> kernel_named(const std::string& name) {
  const std::string own = name.substr(name.rfind(' ') + 1);
  if (own == name) return make_kernel(name);
  const std::optional<double> planted = name.starts_with("wrongly") ? std::optional(-1.0) : std::nullopt;
  return std::make_unique<CarriedFactor>(std::make_unique<Dear>(planted, make_kernel(own)));
}

class RowWorkTest : public testing::TestWithParam<std::string> {
 protected:
  RowWorkTest() {
    step_.prepare(problem_);
    for (int r = 0; r < problem_.row_count(); ++r) {
      weight_.push_back(r % 5 == 0 ? 0 : 1 + 0.1 * (r % 7));
      f_r_.push_back(0.5 - 0.01 * (r % 90));
    }
    kernel_->analyze(step_, parts_, tasks_);
  }

  // Of a second system, after one that differs in a row was factored; a carried factor is still that one.
  void factor(std::vector<double>& weight, const RowWork& before) {
    std::vector<double> others = weight_;
    others[7] = 3;
    ASSERT_TRUE(kernel_->factor(others, tasks_));
    ASSERT_TRUE(kernel_->factor(weight, tasks_, before));
    if (const auto* carried = dynamic_cast<const CarriedFactor*>(kernel_.get())) {
      ASSERT_EQ(carried->counts().factor_reuses, 1);
    }
  }
  std::vector<double> solve(std::vector<double>& f_r, std::vector<double>& dlambda,
                            const RowsAround& around) {
    const std::vector<double> f_v(6 * problem_.body_count(), 0.25);
    std::vector<double> dv(f_v.size());
    kernel_->solve(f_v, f_r, dv, dlambda, tasks_, around);
    return dv;
  }

  StepProblem problem_ = make_pile(5, {.columns = 4, .rows = 4, .layers = 4});
  std::vector<int> parts_ = sliced_parts(problem_.body_count(), 4);
  StageClock clock_;
  ParallelTasks tasks_{clock_, 2};
  PreparedStep step_;
  std::unique_ptr<Kernel> kernel_ = kernel_named(GetParam());
  std::vector<double> weight_, f_r_;
};

TEST_P(RowWorkTest, IsDoneOnceBeforeAndAfter) {
  ASSERT_GT(step_.group_chunks().size(), 1u);
  const std::size_t m = weight_.size();
  std::vector<double> dlambda(m), weight(m, kUnwritten), f_r(m, kUnwritten), later(m, kUnwritten),
      seen(m, kUnwritten);
  factor(weight_, {});
  const std::vector<double> dv = solve(f_r_, dlambda, {});
  std::vector<int> visits(3 * m);
  // into <- from, on rows of the chunk that is named, and counted.
  const auto copy = [&](std::vector<double>& into, const std::vector<double>& from, int kind) -> RowWork {
    return [&, kind](int first, int last, int chunk) {
      EXPECT_EQ(step_.rows_of(step_.group_chunks()[chunk]), std::pair(first, last));
      for (int r = first; r < last; ++r) into[r] = from[r], ++visits[kind * m + r];
    };
  };
  kernel_ = kernel_named(GetParam());
  kernel_->analyze(step_, parts_, tasks_);
  factor(weight, copy(weight, weight_, 0));
  EXPECT_EQ(solve(f_r, later, {copy(f_r, f_r_, 1), copy(seen, later, 2)}), dv);
  EXPECT_EQ(later, dlambda);
  EXPECT_EQ(seen, dlambda);
  EXPECT_EQ(visits, std::vector<int>(3 * m, 1));
}

std::vector<std::string> names() {
  std::vector<std::string> names;
  for (const KernelRow& row : kernel_table()) names.emplace_back(row.name);
  names.insert(names.end(), {"carried monolithic", "carried schur-nested", "wrongly carried monolithic"});
  return names;
}

INSTANTIATE_TEST_SUITE_P(Kernels, RowWorkTest, testing::ValuesIn(names()), [](const auto& of) {
  std::string name = of.param;
  std::ranges::replace_if(
      name, [](char c) { return c == '-' || c == ' '; }, '_');
  return name;
});

// With cones f_r is turned before the kernel sees it, and dlambda back after; what is done around that sees
// rows.
TEST(RowWorkOfCones, SeesRowsAsTheyAre) {
  const StepProblem problem = make_cone_pile(5, 1e-5);
  PreparedStep step;
  step.prepare(problem);
  ASSERT_FALSE(step.set().cones().empty());
  StageClock clock;
  SolveState state(read_direct_options({}), clock);
  SolveSummary summary;
  const std::vector<int> parts = single_part(problem.body_count());
  const std::unique_ptr<Kernel> kernel = make_kernel("monolithic");
  kernel->analyze(step, parts, state.tasks);
  state.begin(step, *kernel, summary, std::vector<double>(problem.row_count(), 0.0));
  std::ranges::fill(state.weight, 1.0);
  for (WeightBlock& block :
       state.cone_blocks()) {  // axes that differ from the rows: a turn in the tangent plane
    std::fill(block.basis.begin(), block.basis.end(), 0.0);
    const int n = block.row_count;
    block.basis[0] = 1;
    if (n == 2) block.basis[3] = -1;
    if (n == 3) block.basis[4] = block.basis[8] = 0.6, block.basis[5] = 0.8, block.basis[7] = -0.8;
  }
  ASSERT_TRUE(state.factor());
  const auto force = [](int r) { return 0.5 - 0.01 * (r % 90); };
  for (int r = 0; r < problem.row_count(); ++r) state.f_r[r] = force(r);
  state.solve();
  const std::vector<double> dlambda = state.dlambda;
  std::ranges::fill(state.f_r, kUnwritten);
  std::vector<double> seen(dlambda.size(), kUnwritten);
  state.solve({[&](int first, int last, int) {
                 for (int r = first; r < last; ++r) state.f_r[r] = force(r);
               },
               [&](int first, int last, int) {
                 std::copy(state.dlambda.begin() + first, state.dlambda.begin() + last, seen.begin() + first);
               }});
  EXPECT_EQ(state.dlambda, dlambda);
  EXPECT_EQ(seen, dlambda);
}

// Velocities from impulses that are written on the way, and slacks that are read where they come up: of rows,
// of turned boxes and of cones.
TEST(RowWorkOfVelocities, IsDoneBeforeAndAfter) {
  const StepProblem pile = make_pile(5, {.columns = 4, .rows = 4, .layers = 4});
  for (const StepProblem& problem :
       {pile, turn_boxes(pile, 5), make_cone_pile(5, 1e-5, ContactSet::coulomb)}) {
    PreparedStep step;
    step.prepare(problem);
    StageClock clock(2);
    SolveState state(read_direct_options({.threads = 2}), clock);
    SolveSummary summary;
    const std::unique_ptr<Kernel> kernel = make_kernel("monolithic");
    state.begin(step, *kernel, summary, std::vector<double>(problem.row_count(), 0.0));
    std::vector<double> impulse(problem.row_count());
    for (int r = 0; r < problem.row_count(); ++r) impulse[r] = 0.5 - 0.01 * (r % 90);
    state.impulse = impulse;
    state.update_velocity_and_shift();  // so that there is a shift
    state.update_velocity();
    const std::vector<double> velocity = state.velocity, slack = state.slack;
    if (step.set().has_coulomb()) {
      std::vector<double> of_rows(slack.size());
      step.slack(velocity, impulse, of_rows);
      EXPECT_NE(slack, of_rows) << "no shift";
    }
    std::ranges::fill(state.impulse, kUnwritten);
    std::vector<double> seen(slack.size(), kUnwritten);
    state.update_velocity(
        {[&](int first, int last, int) {
           std::copy(impulse.begin() + first, impulse.begin() + last, state.impulse.begin() + first);
         },
         [&](int first, int last, int) {
           std::copy(state.slack.begin() + first, state.slack.begin() + last, seen.begin() + first);
         }});
    EXPECT_EQ(state.velocity, velocity);
    EXPECT_EQ(state.slack, slack);
    EXPECT_EQ(seen, slack);
  }
}

}  // namespace
}  // namespace cleave
