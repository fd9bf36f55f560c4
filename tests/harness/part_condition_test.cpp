// The condition number of a part against its definition, written out dense over all bodies.
#include "harness/experiment/part_condition.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace cleave {
namespace {

void add_body(StepProblem& problem, double mass_kg, double inertia_kg_m2) {
  for (int c = 0; c < 36; ++c) {
    const bool diagonal = c % 7 == 0;
    problem.mass.push_back(diagonal ? (c < 18 ? mass_kg : inertia_kg_m2) : 0.0);
  }
  problem.free_velocity.insert(problem.free_velocity.end(), 6, 0.0);
}

void add_row(StepProblem& problem, int a, int b, const std::array<double, 12>& jacobian, double compliance) {
  problem.row_body.insert(problem.row_body.end(), {a, b});
  problem.jacobian.insert(problem.jacobian.end(), jacobian.begin(), jacobian.end());
  problem.rhs.push_back(0);
  problem.compliance.push_back(compliance);
}

// Three bodies, eight rows between 0 and 1, 1 and 2, or 0 and the static world, of compliance 1e-2 to 1e-5.
StepProblem random_problem(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) / 9007199254740992.0; };
  StepProblem problem;
  for (int body = 0; body < 3; ++body) {
    // One after the other: compilers differ in the order in which they evaluate arguments.
    const double inertia_kg_m2 = 0.1 + uniform();
    add_body(problem, std::pow(10, 3 * uniform()), inertia_kg_m2);
  }
  for (int row = 0; row < 8; ++row) {
    std::array<double, 12> jacobian{};
    const int kind = row % 3;
    for (int c = 0; c < (kind == 2 ? 6 : 12); ++c) jacobian[c] = 2 * uniform() - 1;
    add_row(problem, kind == 1 ? 1 : 0, kind == 2 ? -1 : (kind == 1 ? 2 : 1), jacobian,
            std::pow(10, -2 - 3 * uniform()));
  }
  return problem;
}

double one_norm(const Eigen::MatrixXd& a) { return a.cwiseAbs().colwise().sum().maxCoeff(); }

// Of the bodies of one part: rows with a body outside left out.
double exact_condition(const StepProblem& problem, const std::vector<int>& part_of_body, int part) {
  const int n = problem.body_count();
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < 36; ++c) h(6 * i + c / 6, 6 * i + c % 6) = problem.mass[36 * i + c];
  }
  for (int r = 0; r < problem.row_count(); ++r) {
    const int a = problem.row_body[2 * r], b = problem.row_body[2 * r + 1];
    if (b >= 0 && part_of_body[a] != part_of_body[b]) continue;
    Eigen::VectorXd j = Eigen::VectorXd::Zero(6 * n);
    for (int c = 0; c < 6; ++c) {
      j[6 * a + c] = problem.jacobian[12 * r + c];
      if (b >= 0) j[6 * b + c] = problem.jacobian[12 * r + 6 + c];
    }
    h += j * j.transpose() / problem.compliance[r];
  }
  std::vector<int> kept;
  for (int c = 0; c < 6 * n; ++c) {
    if (part_of_body[c / 6] == part) kept.push_back(c);
  }
  const Eigen::MatrixXd of_part = h(kept, kept);
  return one_norm(of_part) * one_norm(of_part.inverse());
}

TEST(PartCondition, IsTheMassRatioOfFreeBodies) {
  StepProblem problem;
  add_body(problem, 2, 1);
  add_body(problem, 800, 4);
  EXPECT_DOUBLE_EQ(largest_part_condition(problem, std::array{0, 0}), 800);
  EXPECT_DOUBLE_EQ(largest_part_condition(problem, std::array{0, 1}), 200);
}

TEST(PartCondition, IsTheLargestOfTheParts) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const StepProblem problem = random_problem(seed);
    for (const std::vector<int>& parts : {std::vector{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 1, 2}}) {
      double exact = 1;
      for (int part = 0; part < 3; ++part) {
        if (std::ranges::count(parts, part) > 0)
          exact = std::max(exact, exact_condition(problem, parts, part));
      }
      const double estimate = largest_part_condition(problem, parts);
      EXPECT_LE(estimate, exact * (1 + 1e-6));
      EXPECT_GE(estimate, 0.3 * exact);
    }
  }
}

TEST(PartCondition, HasNoEndWithoutCompliance) {
  StepProblem problem = random_problem(1);
  problem.compliance[0] = 0;  // between bodies 0 and 1
  EXPECT_TRUE(std::isinf(largest_part_condition(problem, std::array{0, 0, 1})));
  EXPECT_TRUE(std::isfinite(largest_part_condition(problem, std::array{0, 1, 1})));
}

TEST(PartCondition, IsNotMeasuredOfHugeParts) {
  StepProblem problem;
  for (int body = 0; body <= kMostConditionBodies; ++body) add_body(problem, 1, 1);
  EXPECT_TRUE(std::isnan(largest_part_condition(problem, std::vector<int>(problem.body_count(), 0))));
}

}  // namespace
}  // namespace cleave
