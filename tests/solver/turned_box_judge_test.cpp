// The judge on turned boxes, and the steps of the proximal method, which are judged as problems of their own.
#include <gtest/gtest.h>

#include <vector>

#include "solver/proximal_step.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"
#include "tests/solver/turned_boxes.h"

namespace cleave {
namespace {

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

// What strategies scale by and end on.
TEST(TurnedBoxStepTest, DiagonalAndResidualAreThoseOfTheTurnedRows) {
  for (int seed = 0; seed < 5; ++seed) {
    const StepProblem problem = make_turned_pile(seed, 1e-3), turned = in_turned_rows(problem);
    PreparedStep step, expected;
    step.prepare(problem);
    expected.prepare(turned);
    EXPECT_LE(largest_difference(step.diagonal(), expected.diagonal()), 1e-12);
    EXPECT_NEAR(step.least_relative_compliance(), expected.least_relative_compliance(), 1e-12);
    SeededRandom random(seed);
    std::vector<double> impulse(problem.row_count()), slack(problem.row_count());
    for (double& entry : impulse) entry = random.uniform(-0.1, 0.1);
    for (double& entry : slack) entry = random.uniform(-1, 1);
    EXPECT_NEAR(step.residual(impulse, slack), expected.residual(impulse, slack), 1e-12);
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
