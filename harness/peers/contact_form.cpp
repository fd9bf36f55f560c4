#include "harness/peers/contact_form.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

namespace cleave {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Matrix block_of(const DenseProblem& dense, const std::vector<int>& rows, const std::vector<int>& columns) {
  Matrix block(rows.size(), columns.size());
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < columns.size(); ++c)
      block(r, c) = dense.matrix[static_cast<std::size_t>(dense.rows) * rows[r] + columns[c]];
  return block;
}

bool is_free_joint_row(const StepProblem& problem, int row) {
  return problem.row_kind[row] == RowKind::bilateral && std::isinf(problem.lower[row]) &&
         std::isinf(problem.upper[row]);
}

// Empty: it has such a form.
std::string find_refusal(const StepProblem& problem) {
  int contact_rows = 0, normal = -1;
  for (int r = 0; r < problem.row_count(); ++r) {
    const int place = contact_rows % kRowsOfContact;
    if (place == 0 && is_free_joint_row(problem, r)) continue;
    const bool fits = place == 0 ? problem.row_kind[r] == RowKind::normal
                                 : problem.friction_row[r] == normal && r == normal + place;
    if (!fits) {
      return "Siconos takes nothing but contacts of a normal row and two friction rows, and joints without "
             "bounds; row " +
             std::to_string(r) + " is none of them";
    }
    if (place == 0) normal = r;
    ++contact_rows;
  }
  if (contact_rows % kRowsOfContact != 0)
    return "Siconos takes contacts of three rows; the last has not all three";
  return contact_rows == 0 ? "there are no contacts" : "";
}

}  // namespace

ContactForm::ContactForm(const StepProblem& problem) {
  if (const std::string refusal = find_refusal(problem); !refusal.empty())
    throw std::invalid_argument(refusal);
  for (int r = 0; r < problem.row_count(); ++r) {
    (problem.row_kind[r] == RowKind::bilateral ? joint_rows_ : contact_rows_).push_back(r);
    if (problem.row_kind[r] == RowKind::normal)
      friction_coefficient.push_back(problem.friction_coefficient[r + 1]);
  }
  const DenseProblem dense = make_dense_problem(problem);
  const Matrix contacts = block_of(dense, contact_rows_, contact_rows_);
  matrix.assign(contacts.data(), contacts.data() + contacts.size());
  for (const int row : contact_rows_) free_slack.push_back(-dense.right_side[row]);
  if (!joint_rows_.empty()) eliminate_joints(dense);
}

void ContactForm::eliminate_joints(const DenseProblem& dense) {
  const Matrix coupling = block_of(dense, joint_rows_, contact_rows_);
  const Eigen::LLT<Eigen::MatrixXd> joints(block_of(dense, joint_rows_, joint_rows_));
  if (joints.info() != Eigen::Success)
    throw std::invalid_argument(
        "joints depend on each other and have too little compliance to be eliminated");
  Eigen::VectorXd right_side(joint_rows_.size());
  for (std::size_t r = 0; r < joint_rows_.size(); ++r) right_side[r] = dense.right_side[joint_rows_[r]];
  const Matrix response = joints.solve(coupling);
  const Eigen::VectorXd alone = joints.solve(right_side);
  // The lower triangle and its mirror image: W is symmetric to the last bit.
  const Matrix given_way = coupling.transpose() * response;
  const std::size_t m = contact_rows_.size();
  for (std::size_t r = 0; r < m; ++r)
    for (std::size_t c = 0; c <= r; ++c) matrix[m * r + c] = matrix[m * c + r] -= given_way(r, c);
  Eigen::Map<Eigen::VectorXd>(free_slack.data(), m) += coupling.transpose() * alone;
  joint_response_.assign(response.data(), response.data() + response.size());
  joint_impulse_alone_.assign(alone.data(), alone.data() + alone.size());
}

std::vector<double> ContactForm::contact_impulse(std::span<const double> impulse) const {
  std::vector<double> contact;
  for (const int row : contact_rows_) contact.push_back(impulse[row]);
  return contact;
}

std::vector<double> ContactForm::whole_impulse(std::span<const double> contact) const {
  std::vector<double> impulse(contact_rows_.size() + joint_rows_.size());
  for (std::size_t c = 0; c < contact_rows_.size(); ++c) impulse[contact_rows_[c]] = contact[c];
  for (std::size_t r = 0; r < joint_rows_.size(); ++r) {
    double& joint = impulse[joint_rows_[r]] = joint_impulse_alone_[r];
    for (std::size_t c = 0; c < contact.size(); ++c)
      joint -= joint_response_[contact.size() * r + c] * contact[c];
  }
  return impulse;
}

}  // namespace cleave
