// Boxes turned in their tangent planes, from the problem to the answer: the interior point through every
// kernel against the same problem in turned rows, what refuses them, and what the judge says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "solver/proximal_step.h"
#include "solver/registry.h"
#include "solver/step_solver.h"
#include "tests/solver/allocation_counter.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"
#include "tests/solver/turned_boxes.h"

namespace cleave {
namespace {

struct Answer {
  Solution solution;
  SolveSummary summary;
};

Answer solve(const std::string& solver, const StepProblem& problem, const std::vector<int>& parts) {
  Answer answer{cold_start(problem), {}};
  answer.summary = make_step_solver(solver, {})->solve(problem, parts, answer.solution);
  return answer;
}

StepProblem make_turned_pile(int seed, double cfm) {
  return turn_boxes(make_pile(seed, {.columns = 3, .rows = 2, .layers = 3, .cfm = cfm, .mass_ratio = 10}),
                    seed);
}

double largest_difference(std::span<const double> a, std::span<const double> b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

// Of the tangent impulses along the axes of turned boxes, those at a bound that is not zero.
int count_at_bounds(const StepProblem& problem, std::span<const double> impulse) {
  const std::vector<double> axes = along_axes(problem, impulse);
  int count = 0;
  for (int r = 0; r + 2 < problem.row_count(); ++r) {
    for (int k = r + 1; k <= r + 2 && problem.box_angle_rad[r] != 0; ++k) {
      const double bound = problem.upper[k];
      count += bound > 0 && std::abs(std::abs(axes[k]) - bound) <= 1e-12 * bound;
    }
  }
  return count;
}

class TurnedBoxTest : public testing::TestWithParam<std::string> {};  // a kernel

TEST_P(TurnedBoxTest, InteriorPointAgreesWithTheSameProblemInTurnedRows) {
  const std::string solver = "interior-point:" + GetParam();
  int at_bounds = 0;
  for (const double cfm : {1e-4, 1e-5, 1e-8, 1e-11, 0.0}) {
    for (int seed = 0; seed < 4; ++seed) {
      SCOPED_TRACE("cfm " + std::to_string(cfm) + ", seed " + std::to_string(seed));
      const StepProblem problem = make_turned_pile(seed, cfm), turned = in_turned_rows(problem);
      ASSERT_EQ(find_problem_error(problem), "");
      SeededRandom random(seed);
      const std::vector<int> parts = random_parts(random, problem.body_count(), 4);
      const Answer answer = solve(solver, problem, parts), expected = solve(solver, turned, parts);
      EXPECT_TRUE(is_exact(problem, answer.summary, answer.solution));
      EXPECT_TRUE(is_exact(turned, expected.summary, expected.solution));
      EXPECT_EQ(answer.summary.strategy, "interior-point");
      EXPECT_TRUE(velocities_agree(problem, answer.solution.velocity, expected.solution.velocity, 1e-9));
      StepProblem straight = problem;
      straight.box_angle_rad.clear();
      const Answer other = solve(solver, straight, parts);
      EXPECT_GT(largest_difference(other.solution.velocity, expected.solution.velocity), 1e-6);
      at_bounds += count_at_bounds(problem, answer.solution.impulse);
    }
  }
  EXPECT_GT(at_bounds, 100);
}

TEST_P(TurnedBoxTest, WarmStartsAreTurned) {
  const StepProblem problem = make_turned_pile(3, 1e-5);
  const std::vector<int> parts = sliced_parts(problem.body_count(), 4);
  const Answer cold = solve("interior-point:" + GetParam(), problem, parts);
  Answer warm{cold.solution, {}};
  warm.summary = make_step_solver("interior-point:" + GetParam(), {})->solve(problem, parts, warm.solution);
  EXPECT_TRUE(is_exact(problem, warm.summary, warm.solution));
  EXPECT_LT(warm.summary.factorizations, cold.summary.factorizations);
}

TEST_P(TurnedBoxTest, SecondSolveAllocatesNothing) {
  if (GetParam() == "dense") return;  // its matrices are Eigen's
  const StepProblem problem = make_turned_pile(5, 1e-5);
  const std::vector<int> parts = sliced_parts(problem.body_count(), 4);
  for (const std::string strategy : {"interior-point:", "auto:"}) {
    SolveOptions options;
    options.reuse_analysis = true;
    const auto solver = make_step_solver(strategy + GetParam(), options);
    Solution first = cold_start(problem);
    ASSERT_TRUE(is_exact(problem, solver->solve(problem, parts, first), first));
    Solution second = first;
    std::ranges::fill(second.impulse, 0.0);
    const AllocationCount allocations;
    const SolveSummary summary = solver->solve(problem, parts, second);
    EXPECT_EQ(allocations.count(), 0) << strategy;
    EXPECT_EQ(summary.status, SolveStatus::ok);
  }
}

TEST_P(TurnedBoxTest, AnglesOfZeroChangeNoByte) {
  const StepProblem problem = make_pile(2, {.columns = 2, .rows = 2, .layers = 2});
  StepProblem zeros = problem;
  zeros.box_angle_rad.assign(problem.row_count(), 0.0);
  const std::vector<int> parts = sliced_parts(problem.body_count(), 2);
  for (const std::string strategy : {"pivot:", "interior-point:"}) {
    const Answer expected = solve(strategy + GetParam(), problem, parts);
    const Answer answer = solve(strategy + GetParam(), zeros, parts);
    EXPECT_TRUE(same_bytes(answer.solution.impulse, expected.solution.impulse)) << strategy;
    EXPECT_TRUE(same_bytes(answer.solution.velocity, expected.solution.velocity)) << strategy;
  }
}

TEST_P(TurnedBoxTest, AutoTakesTheInteriorPointAndSaysWhy) {
  const StepProblem problem = make_turned_pile(1, 1e-1);  // so soft that it would take pivot
  const std::vector<int> parts = sliced_parts(problem.body_count(), 3);
  const Answer answer = solve("auto:" + GetParam(), problem, parts);
  EXPECT_TRUE(is_exact(problem, answer.summary, answer.solution));
  EXPECT_EQ(answer.summary.strategy, "interior-point");
  EXPECT_EQ(answer.summary.auto_reason, "turned-box");
  EXPECT_EQ(solve("auto:" + GetParam(), in_turned_rows(problem), parts).summary.strategy, "pivot");
}

std::vector<std::string> kernel_names() {
  std::vector<std::string> names;
  for (const KernelRow& row : kernel_table()) names.emplace_back(row.entry.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Kernels, TurnedBoxTest, testing::ValuesIn(kernel_names()), [](const auto& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

void expect_refusal(const std::string& solver, const std::string& named, const StepProblem& problem) {
  const Answer answer = solve(solver, problem, single_part(problem.body_count()));
  EXPECT_EQ(answer.summary.status, SolveStatus::refused) << solver;
  EXPECT_TRUE(answer.summary.message.starts_with(named + " takes an interval for every row"))
      << answer.summary.message;
  EXPECT_NE(answer.summary.message.find("box_angle_rad["), std::string::npos) << answer.summary.message;
  EXPECT_EQ(answer.summary.message.find('\n'), std::string::npos);
  EXPECT_TRUE(same_bytes(answer.solution.impulse, cold_start(problem).impulse)) << solver;
  StepProblem straight = problem;  // which nobody refuses
  straight.box_angle_rad.clear();
  EXPECT_NE(solve(solver, straight, single_part(problem.body_count())).summary.status, SolveStatus::refused);
}

TEST(TurnedBoxRefusalTest, EveryOtherStrategyRefusesByName) {
  const StepProblem problem = make_turned_pile(1, 1e-1);
  int refused = 0;
  for (const StrategyRow& strategy : strategy_table()) {
    const std::string name = strategy.entry.name;
    if (name == "interior-point" || name == "auto") continue;
    for (const KernelRow& kernel : kernel_table()) {
      if (!runs_on(strategy, kernel)) continue;
      expect_refusal(name + ":" + kernel.entry.name, "strategy " + name, problem);
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
    expect_refusal(row.entry.name, "solver " + std::string(row.entry.name), problem);
    ++refused;
  }
  EXPECT_GE(refused, 1);
}

// A solver of another folder that says nothing about sets.
class PlainSolver : public StepSolver {
 public:
  bool uses_partition() const override { return false; }
  bool called = false;

 private:
  SolveSummary do_solve(const StepProblem&, std::span<const int>, Solution&) override {
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

TEST(TurnedBoxJudgeTest, AcceptsTheAnswerOfTheTurnedRowsAndNothingNearIt) {
  int tried = 0;
  for (int seed = 0; seed < 5; ++seed) {
    const StepProblem problem = make_turned_pile(seed, 1e-4), turned = in_turned_rows(problem);
    const Answer answer = solve("dense", turned, {});
    ASSERT_TRUE(is_exact(turned, answer.summary, answer.solution));
    const std::vector<double> right = along_rows(problem, answer.solution.impulse);
    EXPECT_TRUE(judge(problem, right).exact);
    EXPECT_FALSE(judge(problem, answer.solution.impulse).exact) << "axes taken for rows";
    StepProblem mirrored = problem;
    for (double& angle : mirrored.box_angle_rad) angle = -angle;
    EXPECT_FALSE(judge(mirrored, right).exact);
    for (const int contact : contacts_of(problem)) {
      for (int k = 0; k < 3; ++k) {
        std::vector<double> wrong = right;
        wrong[contact + k] += 1e-6;
        EXPECT_FALSE(judge(problem, wrong).exact) << "row " << contact + k;
        ++tried;
      }
    }
  }
  EXPECT_GT(tried, 200);
}

TEST(TurnedBoxJudgeTest, MeasuresWhatItMeasuresOfTheTurnedRows) {
  for (int seed = 0; seed < 5; ++seed) {
    const StepProblem problem = make_turned_pile(seed, 1e-5), turned = in_turned_rows(problem);
    SeededRandom random(seed);
    std::vector<double> impulse(problem.row_count());
    for (double& entry : impulse) entry = random.uniform(-0.1, 0.1);
    const std::vector<double> axes = along_axes(problem, impulse);
    const std::vector<double> actual = row_residuals(problem, impulse),
                              expected = row_residuals(turned, axes);
    EXPECT_LE(largest_difference(actual, expected), 1e-12);
    const ResidualReport report = judge(problem, impulse), of_turned = judge(turned, axes);
    EXPECT_NEAR(report.residual_friction_m_per_s, of_turned.residual_friction_m_per_s, 1e-12);
    EXPECT_NEAR(report.energy_excess_j, of_turned.energy_excess_j, 1e-10);
  }
}

// Steps of the proximal method are problems of the same kind, with the slack of the original at their centre.
TEST(TurnedBoxProximalTest, StepsKeepTheirBoxesAndTheSlackAtTheCentre) {
  for (int seed = 0; seed < 5; ++seed) {
    const StepProblem problem = make_turned_pile(seed, 0);
    PreparedStep step, proximal_step;
    step.prepare(problem);
    SeededRandom random(seed);
    std::vector<double> centre(problem.row_count());
    for (double& entry : centre) entry = random.uniform(-1, 1);
    ProximalStep proximal;
    proximal.begin(step, centre, 1e-3);
    ASSERT_EQ(find_problem_error(proximal.problem()), "");
    const std::vector<double> in_rows = along_rows(problem, centre);
    proximal_step.prepare(proximal.problem());
    std::vector<double> velocity(problem.free_velocity.size()), slack(centre.size()), of_copy(centre.size());
    step.velocity(in_rows, velocity);
    step.slack(velocity, in_rows, slack);
    proximal_step.slack(velocity, in_rows, of_copy);
    EXPECT_LE(largest_difference(slack, of_copy), 1e-13);
    EXPECT_GT(largest_difference(problem.rhs, proximal.problem().rhs), 1e-5);
  }
}

}  // namespace
}  // namespace cleave
