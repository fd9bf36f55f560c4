#include "solver/step_problem.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <functional>
#include <limits>

#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(FindProblemErrorTest, AcceptsWhatTheMakersMake) {
  for (int seed = 0; seed < 300; ++seed) {
    EXPECT_EQ(find_problem_error(make_small_problem(seed)), "") << "seed " << seed;
  }
  EXPECT_EQ(find_problem_error(make_pile(1, {})), "");
  EXPECT_EQ(find_problem_error(make_chain(1, {})), "");
}

TEST(FindProblemErrorTest, AcceptsTurnedBoxesOfContacts) {
  StepProblem problem = make_pile(1, {});
  problem.box_angle_rad.assign(problem.row_count(), 0.0);
  EXPECT_EQ(find_problem_error(problem), "");
  for (int r = 0; r < problem.row_count(); r += 3) problem.box_angle_rad[r] = -1 - 0.1 * r;
  EXPECT_EQ(find_problem_error(problem), "");
}

void give_first_contact(StepProblem& problem, ContactSet set) {
  problem.contact_set.assign(problem.row_count(), ContactSet::box);
  problem.contact_set[0] = set;
  for (int r = 1; r < 3; ++r) problem.lower[r] = -(problem.upper[r] = kInfinity);
}

TEST(FindProblemErrorTest, AcceptsConesOfContactsWithOneTangentOrTwo) {
  StepProblem problem = make_pile(1, {});
  problem.contact_set.assign(problem.row_count(), ContactSet::box);
  EXPECT_EQ(find_problem_error(problem), "");
  for (const ContactSet set : {ContactSet::cone, ContactSet::coulomb}) {
    give_first_contact(problem, set);
    EXPECT_EQ(find_problem_error(problem), "");
    problem.box_angle_rad.assign(problem.row_count(), 0.0);
    problem.box_angle_rad[3] = 0.5;  // of another contact
    EXPECT_EQ(find_problem_error(problem), "");
    StepProblem one = problem;
    one.row_kind[2] = RowKind::bilateral;
    one.friction_row[2] = -1;
    one.friction_coefficient[2] = 0;
    EXPECT_EQ(find_problem_error(one), "");
  }
}

TEST(FindProblemErrorTest, AcceptsBodiesWithoutRowsAndNothingAtAll) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  EXPECT_EQ(find_problem_error(problem), "");
  append_body(problem, 1, {1, 1, 1}, {});
  EXPECT_EQ(find_problem_error(problem), "");
}

TEST(FindProblemErrorTest, AcceptsRoundingErrorsOfRotatedThinBodies) {
  StepProblem problem = make_pile(1, {});
  // A rod of inertia (1e-6, 1, 1) turned by 45 degrees about z, with the last bit of one entry changed.
  const double mean = (1e-6 + 1) / 2, half = (1e-6 - 1) / 2;
  problem.mass[21] = problem.mass[28] = mean;
  problem.mass[22] = half;
  problem.mass[27] = half * (1 + 4e-16);
  problem.mass[35] = 1;
  EXPECT_EQ(find_problem_error(problem), "");
}

// Row 0 of the pile is a normal row, rows 1 and 2 are its friction rows, row 3 is normal again.
struct Damage {
  const char* name;
  std::function<void(StepProblem&)> apply;
  const char* expected;  // start of the message
};

void turn_first_box(StepProblem& problem, double angle) {
  problem.box_angle_rad.assign(problem.row_count(), 0.0);
  problem.box_angle_rad[0] = angle;
}

void make_normal(StepProblem& problem, int row) {
  problem.row_kind[row] = RowKind::normal;
  problem.friction_row[row] = -1;
}

const Damage kDamages[] = {
    {"StepZero", [](StepProblem& p) { p.h_s = 0; }, "h_s = 0, allowed"},
    {"StepNan", [](StepProblem& p) { p.h_s = kNan; }, "h_s = nan, allowed"},
    {"ShapeVelocity", [](StepProblem& p) { p.free_velocity.pop_back(); },
     "size of free_velocity = 161, allowed"},
    {"ShapeMass", [](StepProblem& p) { p.mass.pop_back(); },
     "size of mass = 971, allowed: 972 (36 for each of 27"},
    {"ShapeRhs", [](StepProblem& p) { p.rhs.pop_back(); }, "size of row_body = "},
    {"ShapeRowBody", [](StepProblem& p) { p.row_body.pop_back(); }, "size of row_body = "},
    {"ShapeJacobian", [](StepProblem& p) { p.jacobian.push_back(0); }, "size of jacobian = "},
    {"ShapeCompliance", [](StepProblem& p) { p.compliance.clear(); }, "size of compliance = 0, allowed"},
    {"ShapeLower", [](StepProblem& p) { p.lower.pop_back(); }, "size of lower = "},
    {"ShapeUpper", [](StepProblem& p) { p.upper.pop_back(); }, "size of upper = "},
    {"ShapeKind", [](StepProblem& p) { p.row_kind.pop_back(); }, "size of row_kind = "},
    {"ShapeFrictionRow", [](StepProblem& p) { p.friction_row.pop_back(); }, "size of friction_row = "},
    {"ShapeMu", [](StepProblem& p) { p.friction_coefficient.pop_back(); }, "size of friction_coefficient = "},
    {"ShapeConstraint", [](StepProblem& p) { p.row_constraint.pop_back(); }, "size of row_constraint = "},
    {"ShapePoint", [](StepProblem& p) { p.contact_point.pop_back(); }, "size of contact_point = "},
    {"ShapeWarm", [](StepProblem& p) { p.warm_impulse.pop_back(); }, "size of warm_impulse = "},
    {"NanMass", [](StepProblem& p) { p.mass[40] = kNan; }, "mass[40] = nan, allowed: finite"},
    {"NanVelocity", [](StepProblem& p) { p.free_velocity[7] = kNan; }, "free_velocity[7] = nan, allowed"},
    {"InfiniteJacobian", [](StepProblem& p) { p.jacobian[13] = kInfinity; }, "jacobian[13] = inf, allowed"},
    {"NanRhs", [](StepProblem& p) { p.rhs[4] = kNan; }, "rhs[4] = nan, allowed"},
    {"NanCompliance", [](StepProblem& p) { p.compliance[2] = kNan; }, "compliance[2] = nan, allowed"},
    {"InfiniteCompliance", [](StepProblem& p) { p.compliance[2] = kInfinity; },
     "compliance[2] = inf, allowed"},
    {"NegativeCompliance", [](StepProblem& p) { p.compliance[2] = -1e-9; },
     "compliance[2] = -1e-09, allowed"},
    {"NegativeMu", [](StepProblem& p) { p.friction_coefficient[1] = -0.5; },
     "friction_coefficient[1] = -0.5, allowed"},
    {"NanPoint", [](StepProblem& p) { p.contact_point[5] = kNan; }, "contact_point[5] = nan, allowed"},
    {"NanWarm", [](StepProblem& p) { p.warm_impulse[1] = kNan; }, "warm_impulse[1] = nan, allowed"},
    {"FirstBodyStatic", [](StepProblem& p) { p.row_body[6] = -1; }, "row_body[6] = -1, allowed: 0 to 26"},
    {"FirstBodyTooLarge", [](StepProblem& p) { p.row_body[6] = 27; }, "row_body[6] = 27, allowed: 0 to 26"},
    {"SecondBodyTooLarge", [](StepProblem& p) { p.row_body[7] = 27; }, "row_body[7] = 27, allowed: -1"},
    {"SecondBodyTooSmall", [](StepProblem& p) { p.row_body[7] = -2; }, "row_body[7] = -2, allowed: -1"},
    {"SameBodyTwice", [](StepProblem& p) { p.row_body[7] = p.row_body[6]; },
     "row_body[7] = 0, allowed: another body"},
    {"BoundsCrossed", [](StepProblem& p) { p.lower[1] = 2, p.upper[1] = 1; },
     "lower[1] = 2, allowed: <= upper"},
    {"LowerNan", [](StepProblem& p) { p.lower[1] = kNan; }, "lower[1] = nan, allowed: < +infinity"},
    {"UpperNan", [](StepProblem& p) { p.upper[1] = kNan; }, "upper[1] = nan, allowed: > -infinity"},
    {"LowerInfinite", [](StepProblem& p) { p.lower[0] = kInfinity; }, "lower[0] = inf, allowed: < +infinity"},
    {"UpperInfinite", [](StepProblem& p) { p.upper[0] = -kInfinity; },
     "upper[0] = -inf, allowed: > -infinity"},
    {"KindUnknown", [](StepProblem& p) { p.row_kind[0] = static_cast<RowKind>(3); },
     "row_kind[0] = 3, allowed: 0"},
    {"FrictionWithoutNormal", [](StepProblem& p) { p.friction_row[1] = -1; },
     "friction_row[1] = -1, allowed: the"},
    {"FrictionOfFriction", [](StepProblem& p) { p.friction_row[1] = 2; },
     "friction_row[1] = 2, allowed: the index"},
    {"FrictionBeyondRows", [](StepProblem& p) { p.friction_row[1] = p.row_count(); }, "friction_row[1] = "},
    {"NormalWithFrictionRow", [](StepProblem& p) { p.friction_row[3] = 0; },
     "friction_row[3] = 0, allowed: -1"},
    {"FrictionOfOtherBodies", [](StepProblem& p) { p.row_body[2] = p.row_body[0] == 1 ? 2 : 1; },
     "friction_row[1] = 0, allowed: a normal row between the same bodies"},
    {"MuOfNormal", [](StepProblem& p) { p.friction_coefficient[3] = 0.5; },
     "friction_coefficient[3] = 0.5, allowed: 0 for a row that is not friction"},
    {"ConstraintOfOtherBodies", [](StepProblem& p) { std::ranges::fill(p.row_constraint, 0); },
     "row_constraint[12] = 0, allowed: another id than that of the row before"},
    {"ShapeBoxAngle", [](StepProblem& p) { p.box_angle_rad = {0.1}; },
     "size of box_angle_rad = 1, allowed: "},
    {"NanBoxAngle", [](StepProblem& p) { turn_first_box(p, kNan); },
     "box_angle_rad[0] = nan, allowed: finite"},
    {"BoxAngleOnFriction", [](StepProblem& p) { turn_first_box(p, 0), p.box_angle_rad[1] = 0.5; },
     "box_angle_rad[1] = 0.5, allowed: 0 but on a normal row that its two"},
    {"BoxAngleWithoutTangents", [](StepProblem& p) { turn_first_box(p, 0.5), make_normal(p, 2); },
     "box_angle_rad[0] = 0.5, allowed: 0 but on a normal row"},
    {"BoxAngleOfOtherFriction",
     [](StepProblem& p) { turn_first_box(p, 0.5), p.friction_row[1] = p.friction_row[2] = 3; },
     "box_angle_rad[0] = 0.5, allowed: 0 but on a normal row"},
    {"BoxAngleOfThreeTangents",
     [](StepProblem& p) {
       turn_first_box(p, 0.5), std::copy_n(p.row_body.begin(), 2, p.row_body.begin() + 6);
       p.row_kind[3] = RowKind::friction, p.friction_row[3] = 0;
     },
     "box_angle_rad[0] = 0.5, allowed: 0 but on a normal row"},
    {"BoxAngleOfAStrayTangent",
     [](StepProblem& p) {
       turn_first_box(p, 0.5), std::copy_n(p.row_body.begin(), 6, p.row_body.begin() + 6);
       p.friction_row[4] = 0;
     },
     "friction_row[4] = 0, allowed: another row, as box_angle_rad there is not 0"},
    {"BoxAngleOfOtherBodies", [](StepProblem& p) { turn_first_box(p, 0.5), p.row_body[5] = 1; },
     "box_angle_rad[0] = 0.5, allowed: 0 but on a normal row"},
    {"BoxAngleAtTheEnd",
     [](StepProblem& p) {
       turn_first_box(p, 0), make_normal(p, p.row_count() - 1), p.box_angle_rad.back() = 1;
     },
     "box_angle_rad["},
    {"BoxAngleOfTwoCompliances", [](StepProblem& p) { turn_first_box(p, 0.5), p.compliance[2] *= 2; },
     "box_angle_rad[0] = 0.5, allowed: 0 where the two friction rows differ in compliance, here "},
    {"ShapeContactSet", [](StepProblem& p) { p.contact_set = {ContactSet::cone}; },
     "size of contact_set = 1, allowed: "},
    {"ContactSetUnknown", [](StepProblem& p) { give_first_contact(p, static_cast<ContactSet>(3)); },
     "contact_set[0] = 3, allowed: 0 (box), 1 (cone), 2 (coulomb)"},
    {"ContactSetOnFriction",
     [](StepProblem& p) { give_first_contact(p, ContactSet::box), p.contact_set[1] = ContactSet::cone; },
     "contact_set[1] = 1, allowed: 0 (box) but on a normal row that its one or two"},
    {"ContactSetOnBilateral",
     [](StepProblem& p) { give_first_contact(p, ContactSet::cone), p.row_kind[0] = RowKind::bilateral; },
     "contact_set[0] = 1, allowed: 0 (box) but on a normal row"},
    {"ContactSetWithoutTangents",
     [](StepProblem& p) {
       give_first_contact(p, ContactSet::coulomb);
       for (int r : {1, 2}) make_normal(p, r), p.friction_coefficient[r] = 0;
     },
     "contact_set[0] = 2, allowed: 0 (box) but on a normal row"},
    {"ContactSetOfThreeTangents",
     [](StepProblem& p) {
       give_first_contact(p, ContactSet::cone);
       p.row_kind[3] = RowKind::friction, p.friction_row[3] = 0;
       for (int k : {6, 7}) p.row_body[k] = p.row_body[k - 6];
     },
     "contact_set[0] = 1, allowed: 0 (box) but on a normal row that its one or two"},
    {"ContactSetOfOtherBodies",
     [](StepProblem& p) { give_first_contact(p, ContactSet::cone), p.row_body[3] = 1; },
     "contact_set[0] = 1, allowed: 0 (box) but on a normal row"},
    {"ContactSetOfStrayFriction",
     [](StepProblem& p) {
       give_first_contact(p, ContactSet::cone), p.friction_row[4] = 0;
       for (int k : {8, 9}) p.row_body[k] = p.row_body[k - 8];
     },
     "friction_row[4] = 0, allowed: another row, as contact_set there is no box"},
    {"ContactSetWithoutMu",
     [](StepProblem& p) {
       give_first_contact(p, ContactSet::cone), p.friction_coefficient[1] = p.friction_coefficient[2] = 0;
     },
     "friction_coefficient[1] = 0, allowed: > 0 where contact_set is no box"},
    {"ContactSetOfTwoMus",
     [](StepProblem& p) { give_first_contact(p, ContactSet::cone), p.friction_coefficient[2] = 0.25; },
     "friction_coefficient[2] = 0.25, allowed: that of the row before, 0.5, where contact_set is no box"},
    {"ContactSetLowerOfNormal",
     [](StepProblem& p) { give_first_contact(p, ContactSet::cone), p.lower[0] = -1; },
     "lower[0] = -1, allowed: 0 where contact_set is no box"},
    {"ContactSetUpperOfNormal",
     [](StepProblem& p) { give_first_contact(p, ContactSet::cone), p.upper[0] = 9; },
     "upper[0] = 9, allowed: inf where contact_set is no box"},
    {"ContactSetLowerOfFriction",
     [](StepProblem& p) { give_first_contact(p, ContactSet::cone), p.lower[2] = -2; },
     "lower[2] = -2, allowed: -inf where contact_set is no box"},
    {"ContactSetUpperOfFriction",
     [](StepProblem& p) { give_first_contact(p, ContactSet::cone), p.upper[1] = 2; },
     "upper[1] = 2, allowed: inf where contact_set is no box"},
    {"ContactSetOfATurnedBox",
     [](StepProblem& p) { give_first_contact(p, ContactSet::cone), turn_first_box(p, 0.5); },
     "box_angle_rad[0] = 0.5, allowed: 0 where contact_set is no box"},
    {"MassAsymmetric", [](StepProblem& p) { p.mass[36 + 6] = 1e-6; }, "mass[42] = 1e-06, allowed: symmetric"},
    {"MassZero", [](StepProblem& p) { p.mass[36 + 7] = 0; },
     "mass[43] = 0, allowed: symmetric positive definite"},
    {"MassNegative", [](StepProblem& p) { p.mass[36 + 35] = -1; },
     "mass[71] = -1, allowed: symmetric positive"},
    {"MassIndefinite", [](StepProblem& p) { p.mass[36 + 1] = p.mass[36 + 6] = 2; },
     "mass[43] = 1, allowed: symm"},
    {"MassSingular", [](StepProblem& p) { p.mass[36 + 1] = p.mass[36 + 6] = 1; },
     "mass[43] = 1, allowed: symm"},
};

class FindProblemErrorDamageTest : public testing::TestWithParam<Damage> {};

TEST_P(FindProblemErrorDamageTest, NamesArrayIndexValueAndWhatIsAllowed) {
  StepProblem problem = make_pile(1, {});
  ASSERT_EQ(problem.friction_row[1], 0);
  ASSERT_EQ(problem.row_kind[3], RowKind::normal);
  GetParam().apply(problem);
  const std::string error = find_problem_error(problem);
  EXPECT_TRUE(error.starts_with(GetParam().expected)) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Every, FindProblemErrorDamageTest, testing::ValuesIn(kDamages),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace cleave
