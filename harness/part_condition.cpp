#include "harness/part_condition.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <vector>

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Row = Eigen::Map<const Eigen::Matrix<double, 1, 6>>;
using MassBlock = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>;

// Bodies and interior rows of one part.
struct Part {
  std::vector<int> bodies, rows;
};

std::vector<Part> gather(const StepProblem& problem, std::span<const int> part_of_body,
                         std::vector<int>& index_in_part) {
  const int count = part_of_body.empty() ? 0 : std::ranges::max(part_of_body) + 1;
  std::vector<Part> parts(count);
  for (int body = 0; body < problem.body_count(); ++body) {
    std::vector<int>& bodies = parts[part_of_body[body]].bodies;
    index_in_part.push_back(static_cast<int>(bodies.size()));
    bodies.push_back(body);
  }
  for (int row = 0; row < problem.row_count(); ++row) {
    const int a = problem.row_body[2 * row], b = problem.row_body[2 * row + 1];
    if (b < 0 || part_of_body[a] == part_of_body[b]) parts[part_of_body[a]].rows.push_back(row);
  }
  return parts;
}

Eigen::MatrixXd subsystem(const StepProblem& problem, const Part& part, std::span<const int> index_in_part) {
  const auto size = static_cast<Eigen::Index>(6 * part.bodies.size());
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(size, size);
  for (int body : part.bodies) {
    const int at = 6 * index_in_part[body];
    h.block<6, 6>(at, at) = MassBlock(problem.mass.data() + 36 * body);
  }
  for (int row : part.rows) {
    const double d = 1 / problem.compliance[row];
    const int a = problem.row_body[2 * row], b = problem.row_body[2 * row + 1];
    const Row ja(problem.jacobian.data() + 12 * row), jb(problem.jacobian.data() + 12 * row + 6);
    const int at_a = 6 * index_in_part[a];
    h.block<6, 6>(at_a, at_a) += d * ja.transpose() * ja;
    if (b < 0) continue;
    const int at_b = 6 * index_in_part[b];
    h.block<6, 6>(at_b, at_b) += d * jb.transpose() * jb;
    h.block<6, 6>(at_a, at_b) += d * ja.transpose() * jb;
    h.block<6, 6>(at_b, at_a) += d * jb.transpose() * ja;
  }
  return h;
}

double condition(const StepProblem& problem, const Part& part, std::span<const int> index_in_part) {
  if (part.bodies.empty()) return 1;
  if (part.bodies.size() > kMostConditionBodies) return std::numeric_limits<double>::quiet_NaN();
  if (std::ranges::any_of(part.rows, [&](int row) { return problem.compliance[row] == 0; })) return kInfinity;
  const Eigen::LLT<Eigen::MatrixXd> factor(subsystem(problem, part, index_in_part));
  const double reciprocal = factor.info() == Eigen::Success ? factor.rcond() : 0.0;
  return reciprocal > 0 ? 1 / reciprocal : kInfinity;
}

}  // namespace

double largest_part_condition(const StepProblem& problem, std::span<const int> part_of_body) {
  std::vector<int> index_in_part;
  const std::vector<Part> parts = gather(problem, part_of_body, index_in_part);
  double largest = 1;
  for (const Part& part : parts) {
    const double of_part = condition(problem, part, index_in_part);
    if (!(of_part <= largest)) largest = of_part;
    if (largest != largest) return largest;
  }
  return largest;
}

}  // namespace cleave
