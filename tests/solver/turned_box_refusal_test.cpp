// Who takes no turned box refuses it by name.
#include <gtest/gtest.h>

#include <string>

#include "solver/registry.h"
#include "solver/step_solver.h"
#include "tests/solver/cone_contacts.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"
#include "tests/solver/turned_boxes.h"

namespace cleave {
namespace {

void expect_refusal(const std::string& solver, const std::string& named, const StepProblem& problem) {
  const Answer answer = solve(solver, problem, single_part(problem.body_count()));
  EXPECT_EQ(answer.summary.status, SolveStatus::refused) << solver;
  EXPECT_TRUE(answer.summary.message.starts_with(named + " takes an interval for every row"))
      << answer.summary.message;
  EXPECT_NE(answer.summary.message.find("box_angle_rad["), std::string::npos) << answer.summary.message;
  EXPECT_EQ(answer.summary.message.find('\n'), std::string::npos);
  EXPECT_TRUE(same_bytes(answer.solution.impulse, cold_start(problem).impulse)) << solver;
  StepProblem straight = problem;  // which nobody refuses for its set
  straight.box_angle_rad.clear();
  const SolveSummary summary = solve(solver, straight, single_part(problem.body_count())).summary;
  EXPECT_EQ(summary.message.find("takes an interval"), std::string::npos) << summary.message;
}

TEST(TurnedBoxRefusalTest, EveryOtherStrategyRefusesByName) {
  const StepProblem problem = make_turned_pile(1, 1e-1);
  int refused = 0;
  for (const StrategyRow& strategy : strategy_table()) {
    const std::string name = strategy.name;
    if (name == "interior-point" || name == "auto") continue;
    for (const KernelRow& kernel : kernel_table()) {
      if (!runs_on(strategy, kernel)) continue;
      expect_refusal(name + ":" + kernel.name, "strategy " + name, problem);
      ++refused;
    }
  }
  EXPECT_GE(refused, 11);
}

TEST(TurnedBoxRefusalTest, EveryBaselineRefusesByName) {
  const StepProblem problem = make_turned_pile(1, 1e-1);
  int refused = 0;
  for (const SolverRow& row : solver_table()) {
    if (row.make == nullptr) continue;
    expect_refusal(row.name, "solver " + std::string(row.name), problem);
    ++refused;
  }
  EXPECT_GE(refused, 1);
}

// Whoever takes no cone says so, by name, and leaves the impulses alone.
TEST(ConeRefusalTest, EveryOtherSolverRefusesByName) {
  const StepProblem problem = make_cone_pile(1, 1e-1);
  ASSERT_EQ(find_problem_error(problem), "");
  int refused = 0;
  for (const std::string& name : all_solver_names()) {
    if (name == "exact" || name.starts_with("auto:") || name.starts_with("interior-point:")) continue;
    const Answer answer = solve(name, problem, single_part(problem.body_count()));
    EXPECT_EQ(answer.summary.status, SolveStatus::refused) << name;
    EXPECT_NE(answer.summary.message.find("contact_set["), std::string::npos) << answer.summary.message;
    EXPECT_TRUE(same_bytes(answer.solution.impulse, cold_start(problem).impulse)) << name;
    ++refused;
  }
  EXPECT_GE(refused, 20);
}

// A solver of another folder that says nothing about sets.
class PlainSolver : public StepSolver {
 public:
  bool uses_partition() const override { return false; }
  bool called = false;

 private:
  SolveSummary do_solve(const StepProblem&, const Parts&, Solution&) override {
    called = true;
    return {};
  }
};

TEST(TurnedBoxRefusalTest, SolversThatSayNothingRefuse) {
  const StepProblem problem = make_turned_pile(1, 1e-5);
  PlainSolver solver;
  Solution solution = cold_start(problem);
  const SolveSummary summary = solver.solve(problem, {}, solution);
  EXPECT_EQ(summary.status, SolveStatus::refused);
  EXPECT_TRUE(summary.message.starts_with("this solver takes an interval")) << summary.message;
  EXPECT_FALSE(solver.called);
  EXPECT_EQ(solver.solve(make_pile(1, {}), {}, solution).status, SolveStatus::ok);
}

}  // namespace
}  // namespace cleave
