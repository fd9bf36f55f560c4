#include "harness/files/interface_matrix.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>

namespace cleave {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

SparseMatrix matrix_of(int rows, int columns, const std::vector<MatrixEntry>& entries) {
  std::vector<Eigen::Triplet<double>> triplets;
  for (const MatrixEntry& entry : entries) triplets.emplace_back(entry.row, entry.column, entry.value);
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

bool is_interface(const StepProblem& problem, int row, const std::vector<int>& part_of_body) {
  const int a = problem.row_body[2 * std::size_t(row)], b = problem.row_body[2 * std::size_t(row) + 1];
  return b >= 0 && part_of_body[a] != part_of_body[b];
}

std::vector<MatrixEntry> lower_mass(const StepProblem& problem) {
  std::vector<MatrixEntry> entries;
  for (int body = 0; body < problem.body_count(); ++body)
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b <= a; ++b)
        entries.push_back({6 * body + a, 6 * body + b, problem.mass[36 * std::size_t(body) + 6 * a + b]});
  return entries;
}

}  // namespace

std::vector<MatrixEntry> system_entries(const StepProblem& problem, const std::vector<int>& rows) {
  std::vector<MatrixEntry> entries = lower_mass(problem);
  for (const int row : rows) {
    const double compliance = problem.compliance[row];
    if (compliance <= 0)
      throw std::invalid_argument("--matrix: has C^-1 in it, and compliance of row " + std::to_string(row) +
                                  " = 0, allowed: > 0");
    const std::vector<MatrixEntry> jacobian = jacobian_entries(problem, row);
    for (const MatrixEntry& a : jacobian)
      for (const MatrixEntry& b : jacobian)
        if (a.column >= b.column) entries.push_back({a.column, b.column, a.value * b.value / compliance});
  }
  return entries;
}

std::vector<int> interface_rows(const StepProblem& problem, const std::vector<int>& part_of_body) {
  std::vector<int> rows;
  for (int row = 0; row < problem.row_count(); ++row)
    if (is_interface(problem, row, part_of_body)) rows.push_back(row);
  return rows;
}

std::vector<MatrixEntry> interface_entries(const StepProblem& problem, const std::vector<int>& part_of_body) {
  const std::vector<int> across = interface_rows(problem, part_of_body);
  std::vector<int> inside;
  for (int row = 0; row < problem.row_count(); ++row)
    if (!is_interface(problem, row, part_of_body)) inside.push_back(row);
  const int size = 6 * problem.body_count(), count = static_cast<int>(across.size());
  const Eigen::SimplicialLLT<SparseMatrix> factor(matrix_of(size, size, system_entries(problem, inside)));
  if (factor.info() != Eigen::Success)
    throw std::invalid_argument(
        "--matrix: S needs a factor of the rows within parts, which are too stiff for one");
  std::vector<MatrixEntry> jacobian, entries;
  for (int c = 0; c < count; ++c)
    for (const MatrixEntry& entry : jacobian_entries(problem, across[c]))
      jacobian.push_back({entry.column, c, entry.value});
  const SparseMatrix transposed = matrix_of(size, count, jacobian);
  for (int c = 0; c < count; ++c) {
    const Eigen::VectorXd column = transposed.transpose() * factor.solve(transposed.col(c).toDense());
    for (int r = c; r < count; ++r) entries.push_back({r, c, column[r]});
    entries.push_back({c, c, problem.compliance[across[c]]});
  }
  return entries;
}

}  // namespace cleave
