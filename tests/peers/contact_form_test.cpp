// The form without joints against the whole dense problem: contacts see the same slacks, and joints hold.
#include "harness/peers/contact_form.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "tests/peers/coulomb_problems.h"

namespace cleave {
namespace {

const PileOptions kPile{.columns = 2, .rows = 1, .layers = 2, .cfm = 1e-4, .mu = 0.3};

void append_ball_joint(StepProblem& problem, double compliance) {
  for (int axis = 0; axis < 3; ++axis) {
    RowSpec row{.body_a = 0, .body_b = 1, .rhs = 0.1 * axis, .compliance = compliance};
    row.jacobian_a[axis] = 1;
    row.jacobian_b[axis] = -1;
    row.jacobian_a[3 + (axis + 1) % 3] = 0.3;
    append_row(problem, row);
  }
}

RowSpec row_of(const StepProblem& problem, int r, int shift) {
  RowSpec row{problem.row_body[2 * r], problem.row_body[2 * r + 1]};
  std::copy_n(&problem.jacobian[12 * r], 6, row.jacobian_a.begin());
  std::copy_n(&problem.jacobian[12 * r + 6], 6, row.jacobian_b.begin());
  row.rhs = problem.rhs[r];
  row.compliance = problem.compliance[r];
  row.lower = problem.lower[r];
  row.upper = problem.upper[r];
  row.kind = problem.row_kind[r];
  row.friction_row = problem.friction_row[r] < 0 ? -1 : problem.friction_row[r] + shift;
  row.friction_coefficient = problem.friction_coefficient[r];
  return row;
}

// A pile of four blocks, with ball joints between the first two before and behind the rows of its contacts.
StepProblem jointed_pile(int joints_before, int joints_behind) {
  const StepProblem pile = make_pile(1, kPile);
  StepProblem problem;
  problem.h_s = pile.h_s;
  problem.mass = pile.mass;
  problem.free_velocity = pile.free_velocity;
  for (int joint = 0; joint < joints_before; ++joint) append_ball_joint(problem, 1e-4);
  const int shift = problem.row_count();
  for (int r = 0; r < pile.row_count(); ++r) append_row(problem, row_of(pile, r, shift));
  for (int joint = 0; joint < joints_behind; ++joint) append_ball_joint(problem, 1e-3);
  return with_coulomb(problem);
}

// (m) A lambda - g
std::vector<double> slacks(const StepProblem& problem, const std::vector<double>& impulse) {
  const DenseProblem dense = make_dense_problem(problem);
  std::vector<double> w(dense.rows);
  for (int r = 0; r < dense.rows; ++r) {
    w[r] = -dense.right_side[r];
    for (int c = 0; c < dense.rows; ++c) w[r] += dense.matrix[dense.rows * r + c] * impulse[c];
  }
  return w;
}

TEST(ContactForm, WithoutJointsIsTheDenseProblem) {
  const StepProblem pile = jointed_pile(0, 0);
  const DenseProblem dense = make_dense_problem(pile);
  const ContactForm form(pile);
  EXPECT_EQ(form.matrix, dense.matrix);
  EXPECT_EQ(form.contact_count(), pile.row_count() / 3);
  for (int r = 0; r < pile.row_count(); ++r) EXPECT_EQ(form.free_slack[r], -dense.right_side[r]);
}

TEST(ContactForm, JointsHoldWhateverTheContactsCarry) {
  const StepProblem pile = jointed_pile(0, 0);
  for (const auto& [before, behind] : {std::pair{1, 0}, {0, 1}, {1, 1}}) {
    const StepProblem problem = jointed_pile(before, behind);
    const ContactForm form(problem);
    const int m = kRowsOfContact * form.contact_count();
    ASSERT_EQ(m, pile.row_count());
    std::vector<double> contact(m);
    for (int c = 0; c < m; ++c) contact[c] = 0.1 * (c % 7) - 0.2;
    const std::vector<double> whole = form.whole_impulse(contact);
    EXPECT_EQ(form.contact_impulse(whole), contact);
    const std::vector<double> w = slacks(problem, whole);
    for (int r = 0, c = 0; r < problem.row_count(); ++r) {
      double expected = 0;
      if (problem.row_kind[r] != RowKind::bilateral) {
        expected = form.free_slack[c];
        for (int k = 0; k < m; ++k) expected += form.matrix[m * c + k] * contact[k];
        ++c;
      }
      EXPECT_NEAR(w[r], expected, 1e-11) << "row " << r << ", joints " << before << " and " << behind;
    }
    for (int r = 0; r < m; ++r)
      for (int c = 0; c < r; ++c) EXPECT_EQ(form.matrix[m * r + c], form.matrix[m * c + r]);
  }
}

std::string refusal_of(const StepProblem& problem) {
  try {
    ContactForm{problem};
  } catch (const std::invalid_argument& refusal) {
    return refusal.what();
  }
  return "";
}

TEST(ContactForm, RefusesWhatIsNoContactAndNoFreeJoint) {
  EXPECT_EQ(refusal_of(make_chain(1, {.links = 3})), "there are no contacts");
  StepProblem motor = jointed_pile(1, 0);
  motor.upper[1] = 5;
  EXPECT_NE(refusal_of(motor).find("row 1 "), std::string::npos) << refusal_of(motor);
  StepProblem smooth = make_pile(1, {.columns = 1, .rows = 1, .layers = 1, .cfm = 1e-4, .mu = 0});
  EXPECT_NE(refusal_of(smooth).find("row 1 "), std::string::npos) << refusal_of(smooth);
  StepProblem rigid = jointed_pile(2, 0);
  for (double& compliance : rigid.compliance) compliance = 0;
  EXPECT_NE(refusal_of(rigid).find("joints depend on each other"), std::string::npos) << refusal_of(rigid);
}

}  // namespace
}  // namespace cleave
