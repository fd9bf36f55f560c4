// The dense problem against the definition, written out with whole matrices.
#include "harness/peers/dense_problem.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

// M, J and v0 as one matrix each.
struct Whole {
  Eigen::MatrixXd mass, jacobian;
  Eigen::VectorXd free_velocity;
};

Whole whole(const StepProblem& p) {
  const int n = p.body_count(), m = p.row_count();
  Whole w{Eigen::MatrixXd::Zero(6 * n, 6 * n), Eigen::MatrixXd::Zero(m, 6 * n),
          Eigen::Map<const Eigen::VectorXd>(p.free_velocity.data(), 6 * n)};
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 36; ++k) w.mass(6 * i + k / 6, 6 * i + k % 6) = p.mass[36 * i + k];
  for (int r = 0; r < m; ++r)
    for (int k = 0; k < 12; ++k)
      if (const int body = p.row_body[2 * r + k / 6]; body >= 0)
        w.jacobian(r, 6 * body + k % 6) = p.jacobian[12 * r + k];
  return w;
}

TEST(DenseProblem, IsTheMatrixOfTheDefinition) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const StepProblem problem = make_small_problem(seed, {.mass_ratio = 100});
    const Whole w = whole(problem);
    Eigen::MatrixXd expected = w.jacobian * w.mass.inverse() * w.jacobian.transpose();
    for (int r = 0; r < problem.row_count(); ++r) expected(r, r) += problem.compliance[r];
    const Eigen::VectorXd moved = w.jacobian * w.free_velocity;
    const DenseProblem dense = make_dense_problem(problem);
    ASSERT_EQ(dense.rows, problem.row_count());
    for (int r = 0; r < dense.rows; ++r) {
      EXPECT_NEAR(dense.right_side[r], problem.rhs[r] - moved[r], 1e-12 * (1 + std::abs(moved[r]))) << seed;
      for (int c = 0; c < dense.rows; ++c) {
        EXPECT_NEAR(dense.matrix[dense.rows * r + c], expected(r, c), 1e-12 * (1 + expected.norm()))
            << "seed " << seed << ", " << r << ", " << c;
        EXPECT_EQ(dense.matrix[dense.rows * r + c], dense.matrix[dense.rows * c + r]);
      }
    }
  }
}

}  // namespace
}  // namespace cleave
