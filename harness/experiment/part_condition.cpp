#include "harness/experiment/part_condition.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/interface_split.h"
#include "solver/linear/eigen_blocking.h"

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Row = Eigen::Map<const Eigen::Matrix<double, 1, 6>>;
using MassBlock = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>;

Eigen::MatrixXd subsystem(const PreparedStep& step, const PartRows& part,
                          std::span<const int> local_of_body) {
  const StepProblem& problem = step.problem();
  const auto size = static_cast<Eigen::Index>(6 * part.bodies.size());
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(size, size);
  for (int body : part.bodies) {
    const int at = 6 * local_of_body[body];
    h.block<6, 6>(at, at) = MassBlock(problem.mass.data() + 36 * body);
  }
  for (int g : part.groups) {
    const RowGroup& group = step.groups()[g];
    const int at_a = 6 * local_of_body[group.body_a];
    for (int row = group.first_row; row < group.first_row + group.row_count; ++row) {
      const double d = 1 / problem.compliance[row];
      const Row ja(problem.jacobian.data() + 12 * row), jb(problem.jacobian.data() + 12 * row + 6);
      h.block<6, 6>(at_a, at_a) += d * ja.transpose() * ja;
      if (group.body_b < 0) continue;
      const int at_b = 6 * local_of_body[group.body_b];
      h.block<6, 6>(at_b, at_b) += d * jb.transpose() * jb;
      h.block<6, 6>(at_a, at_b) += d * ja.transpose() * jb;
      h.block<6, 6>(at_b, at_a) += d * jb.transpose() * ja;
    }
  }
  return h;
}

bool has_rigid_row(const PreparedStep& step, const PartRows& part) {
  return std::ranges::any_of(part.groups, [&](int g) {
    const RowGroup& group = step.groups()[g];
    const auto first = step.problem().compliance.begin() + group.first_row;
    return std::find(first, first + group.row_count, 0.0) != first + group.row_count;
  });
}

double condition(const PreparedStep& step, const PartRows& part, std::span<const int> local_of_body) {
  if (part.bodies.empty()) return 1;
  if (part.bodies.size() > kMostConditionBodies) return std::numeric_limits<double>::quiet_NaN();
  if (has_rigid_row(step, part)) return kInfinity;
  const Eigen::LLT<Eigen::MatrixXd> factor(subsystem(step, part, local_of_body));
  const double reciprocal = factor.info() == Eigen::Success ? factor.rcond() : 0.0;
  return reciprocal > 0 ? 1 / reciprocal : kInfinity;
}

}  // namespace

double largest_part_condition(const StepProblem& problem, std::span<const int> part_of_body) {
  fix_eigen_blocking();
  PreparedStep step;
  step.prepare(problem);
  InterfaceSplit split;
  split.split(step, part_of_body);
  double largest = 1;
  for (int part = 0; part < split.part_count; ++part) {
    const double of_part = condition(step, split.parts[part], split.local_of_body);
    if (!(of_part <= largest)) largest = of_part;
    if (std::isnan(largest)) return largest;
  }
  return largest;
}

double largest_part_condition(const Cell& cell) {
  if (cell.graph == nullptr) return std::numeric_limits<double>::quiet_NaN();
  return largest_part_condition(cell.problem, cell.part_of_body);
}

}  // namespace cleave
