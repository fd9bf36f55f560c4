#include "harness/peers/dense_problem.h"

#include <Eigen/Cholesky>
#include <cstddef>

namespace cleave {
namespace {

using Block = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
using Vector = Eigen::Matrix<double, 6, 1>;

// A row's part on one body.
struct RowSide {
  int row;
  Vector jacobian;
};

std::vector<std::vector<RowSide>> sides_by_body(const StepProblem& problem) {
  std::vector<std::vector<RowSide>> sides(problem.body_count());
  for (int r = 0; r < problem.row_count(); ++r)
    for (int side = 0; side < 2; ++side)
      if (const int body = problem.row_body[2 * r + side]; body >= 0)
        sides[body].push_back({r, Eigen::Map<const Vector>(&problem.jacobian[12 * r + 6 * side])});
  return sides;
}

}  // namespace

DenseProblem make_dense_problem(const StepProblem& problem) {
  DenseProblem dense;
  const std::size_t m = problem.rhs.size();
  dense.rows = static_cast<int>(m);
  dense.matrix.assign(m * m, 0.0);
  dense.right_side = problem.rhs;
  const std::vector<std::vector<RowSide>> sides = sides_by_body(problem);
  for (int i = 0; i < problem.body_count(); ++i) {
    const Eigen::LLT<Block> mass(Eigen::Map<const Block>(&problem.mass[36 * i]));
    const Eigen::Map<const Vector> free_velocity(&problem.free_velocity[6 * i]);
    for (std::size_t a = 0; a < sides[i].size(); ++a) {
      const Vector moved = mass.solve(sides[i][a].jacobian);
      dense.right_side[sides[i][a].row] -= sides[i][a].jacobian.dot(free_velocity);
      for (std::size_t b = 0; b <= a; ++b)
        dense.matrix[m * sides[i][a].row + sides[i][b].row] += sides[i][b].jacobian.dot(moved);
    }
  }
  // Rows of a body ascend, so that only the lower triangle was written.
  for (std::size_t r = 0; r < m; ++r) {
    dense.matrix[(m + 1) * r] += problem.compliance[r];
    for (std::size_t c = 0; c < r; ++c) dense.matrix[m * c + r] = dense.matrix[m * r + c];
  }
  return dense;
}

}  // namespace cleave
