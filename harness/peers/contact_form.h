// A step problem as Siconos knows it: contacts alone. Joints are eliminated, as their rows hold as equations:
//
//     A_jj lambda_j = g_j - A_jc lambda_c        (A, g of dense_problem.h; j rows of joints, c of contacts)
//     W = A_cc - A_cj A_jj^-1 A_jc,    q = A_cj A_jj^-1 g_j - g_c,       u = W lambda_c + q
//
// Without joints W is J M^-1 J^T + C and q is J v0 - b, to the last bit.
#pragma once

#include <span>
#include <vector>

#include "harness/peers/dense_problem.h"

namespace cleave {

inline constexpr int kRowsOfContact = 3;  // a normal and two tangents

class ContactForm {
 public:
  // Throws std::invalid_argument with one line that names the row: what is neither the row of a joint without
  // bounds nor of a contact of one normal row and two friction rows that follow it. So where there are no
  // contacts, and where joints depend on each other and have no compliance.
  explicit ContactForm(const StepProblem& problem);

  int contact_count() const { return static_cast<int>(friction_coefficient.size()); }
  std::vector<double> contact_impulse(std::span<const double> impulse) const;  // (m) to (3 contacts)
  std::vector<double> whole_impulse(std::span<const double> contact) const;    // (3 contacts) to (m)

  std::vector<double> matrix;                // (3 contacts, 3 contacts) W, row-major
  std::vector<double> free_slack;            // (3 contacts) q, m/s
  std::vector<double> friction_coefficient;  // (contacts)

 private:
  void eliminate_joints(const DenseProblem& dense);

  std::vector<int> contact_rows_, joint_rows_;
  std::vector<double> joint_response_;       // (joint rows, 3 contacts) A_jj^-1 A_jc
  std::vector<double> joint_impulse_alone_;  // (joint rows) A_jj^-1 g_j
};

}  // namespace cleave
