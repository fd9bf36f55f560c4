// Whole steps against mechanics on paper: friction on an incline, the pendulum, the hanging chain, the stack.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/harness/ode_test_world.h"
#include "tests/harness/world_stepper.h"

namespace cleave {
namespace {

constexpr double kGravity_m_per_s2 = 9.81;

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// --- incline: a flat box on a plane turned about a world axis, so that one tangent points down the slope

struct Incline {
  bool about_x;  // else about y
  double mu;
  FrictionModel friction;
};

void PrintTo(const Incline& incline, std::ostream* out) {
  *out << (incline.about_x ? "about x" : "about y") << ", mu " << incline.mu << ", "
       << (incline.friction == FrictionModel::box ? "box" : "box-converged");
}

class InclineTest : public testing::TestWithParam<Incline> {
 protected:
  static constexpr double kMass_kg = 3;
  static constexpr double kCfm = 1e-6;
  static constexpr double kStep_s = 1.0 / 60;

  // The plane's angle is atan(tangent).
  WorldStepper make_box(double tangent) {
    const double angle = std::atan(tangent);
    const double s = std::sin(angle), c = std::cos(angle);
    const std::array<double, 3> normal = GetParam().about_x ? std::array{0.0, s, c} : std::array{s, 0.0, c};
    down_ = GetParam().about_x ? std::array{0.0, c, -s} : std::array{c, 0.0, -s};
    const double height_m = 0.1 - 1e-6;
    auto world = make_world([&](SceneBuilder& builder) {
      const Pose pose{{height_m * normal[0], height_m * normal[1], height_m * normal[2]},
                      orientation_along(normal)};
      builder.add_box(pose, kMass_kg, {1, 1, 0.2});
      builder.add_plane(normal, 0);
    });
    ExtractOptions options;
    options.h_s = kStep_s;
    options.cfm = kCfm;
    options.mu = GetParam().mu;
    options.friction = GetParam().friction;
    return {std::move(world), options};
  }

  double speed_m_per_s(const WorldStepper& stepper) const {
    const auto u = stepper.state(0).velocity;
    return dot({u[0], u[1], u[2]}, down_);
  }

  std::array<double, 3> down_{};  // unit, down the slope
};

// Compliance lets a held contact creep: w = v + C lambda = 0 with lambda = h F, so v = cfm F, where four
// contacts share F = m g sin a. Near the friction limit those uphill slip first and the others carry more,
// never fewer than one.
TEST_P(InclineTest, HoldsBelowTheFrictionAngle) {
  for (const double part_of_mu : {0.3, 0.97, 0.999}) {
    const double tangent = part_of_mu * GetParam().mu;
    WorldStepper box = make_box(tangent);
    box.steps(240);
    const double weight_down_n = kMass_kg * kGravity_m_per_s2 * std::sin(std::atan(tangent));
    const double creep_m_per_s = kCfm * weight_down_n / 4;
    EXPECT_GE(speed_m_per_s(box), creep_m_per_s * (1 - 1e-6)) << part_of_mu;
    EXPECT_LE(speed_m_per_s(box), creep_m_per_s * (part_of_mu < 0.5 ? 1 + 1e-6 : 4)) << part_of_mu;
    EXPECT_EQ(box.problem().row_count(), 12);
    EXPECT_EQ(box.inexact_steps(), 0);
    EXPECT_EQ(box.unconverged_bounds(), 0);
  }
}

// `box` predicts its bounds; contacts that moved too far to be recognised are predicted from nothing.
TEST_P(InclineTest, SlidesAboveItWithTheAccelerationThatIsLeft) {
  for (const double part_of_mu : {1.001, 1.03, 1.5}) {
    const bool fast_box = GetParam().friction == FrictionModel::box && part_of_mu > 1.4;
    const double tolerance = fast_box ? 1e-3 : 1e-5;
    const double tangent = part_of_mu * GetParam().mu;
    const double angle = std::atan(tangent);
    WorldStepper box = make_box(tangent);
    box.steps(120);
    const double before_m_per_s = speed_m_per_s(box);
    box.steps(60);
    const double acceleration = (speed_m_per_s(box) - before_m_per_s) / (60 * kStep_s);
    const double expected = kGravity_m_per_s2 * (std::sin(angle) - GetParam().mu * std::cos(angle));
    EXPECT_NEAR(acceleration, expected, tolerance * kGravity_m_per_s2) << part_of_mu;
    EXPECT_NEAR(before_m_per_s, 2 * expected, 0.02) << part_of_mu;
    EXPECT_EQ(box.inexact_steps(), 0);
    EXPECT_EQ(box.unconverged_bounds(), 0);
  }
}

// mu = 1.2: an angle beyond 45 degrees, where dPlaneSpace chooses its tangents otherwise.
INSTANTIATE_TEST_SUITE_P(ClosedForm, InclineTest,
                         testing::Values(Incline{false, 0.5, FrictionModel::box_converged},
                                         Incline{true, 0.5, FrictionModel::box_converged},
                                         Incline{false, 1.2, FrictionModel::box_converged},
                                         Incline{true, 1.2, FrictionModel::box_converged},
                                         Incline{false, 0.5, FrictionModel::box}));

// --- pendulum: a sphere held by the world on a ball joint

constexpr double kArm_m = 0.7, kBob_kg = 2, kBobRadius_m = 0.1;

// Time of one swing from rest at the amplitude, between the first and the third passage through the lowest
// point.
double measure_period_s(double amplitude_rad, double step_s) {
  auto world = make_world([&](SceneBuilder& builder) {
    const Pose pose{{kArm_m * std::sin(amplitude_rad), 0, -kArm_m * std::cos(amplitude_rad)}, {1, 0, 0, 0}};
    builder.add_ball_joint(builder.add_sphere(pose, kBob_kg, kBobRadius_m), nullptr, {0, 0, 0});
  });
  ExtractOptions options;
  options.h_s = step_s;
  options.cfm = 1e-9;
  WorldStepper pendulum(std::move(world), options);
  std::vector<double> passages_s;
  double angle = amplitude_rad;
  for (int step = 1; passages_s.size() < 3 && step < 10 / step_s; ++step) {
    pendulum.step();
    const auto x = pendulum.state(0).position_m;
    const double next = std::atan2(x[0], -x[2]);
    if (angle * next < 0 && std::abs(next) < 1) {  // not the jump of atan2 above the joint
      passages_s.push_back((step - 1 + angle / (angle - next)) * step_s);
    }
    angle = next;
  }
  EXPECT_EQ(pendulum.inexact_steps(), 0);
  return passages_s.size() == 3 ? passages_s[2] - passages_s[0] : std::nan("");
}

// T = 4 sqrt(I / (m g l)) K(sin(amplitude / 2)) with the inertia I about the joint; 2 pi sqrt(I / (m g l))
// for small swings.
TEST(PendulumTest, PeriodIsTheEllipticIntegral) {
  const double inertia = kBob_kg * (kArm_m * kArm_m + 0.4 * kBobRadius_m * kBobRadius_m);
  const double time_s = std::sqrt(inertia / (kBob_kg * kGravity_m_per_s2 * kArm_m));
  EXPECT_NEAR(measure_period_s(0.01, 1e-3), 2 * std::numbers::pi * time_s, 1e-4 * time_s);
  for (const double amplitude_rad : {1.0, 2.5}) {
    const double expected_s = 4 * time_s * std::comp_ellint_1(std::sin(amplitude_rad / 2));
    EXPECT_GT(expected_s, 6.69 * time_s);
    EXPECT_NEAR(measure_period_s(amplitude_rad, 1e-3), expected_s, 1e-4 * expected_s) << amplitude_rad;
  }
}

// --- chain: spheres hung below each other from the world

TEST(HangingChainTest, EveryJointCarriesTheWeightBelowIt) {
  const std::vector<double> mass_kg = {1, 4, 0.5, 20, 2, 1, 50};
  const int links = static_cast<int>(mass_kg.size());
  auto world = make_world([&](SceneBuilder& builder) {
    dBodyID above = nullptr;
    for (int i = 0; i < links; ++i) {
      const dBodyID link = builder.add_sphere({{0, 0, -0.5 - i}, {1, 0, 0, 0}}, mass_kg[i], 0.1);
      builder.add_ball_joint(link, above, {0, 0, -1.0 * i});
      above = link;
    }
  });
  ExtractOptions options;
  options.cfm = 1e-5;
  WorldStepper chain(std::move(world), options);
  chain.steps(600);

  double weight_n = 0;
  std::vector<double> tension_n(links);
  for (int i = links - 1; i >= 0; --i) tension_n[i] = weight_n += mass_kg[i] * kGravity_m_per_s2;
  double lowered_m = 0;
  for (int i = 0; i < links; ++i) {
    const std::array<double, 3> force_n = chain.force_n(i, i);  // joint i holds link i
    EXPECT_NEAR(force_n[0], 0, 1e-9 * weight_n) << "joint " << i;
    EXPECT_NEAR(force_n[1], 0, 1e-9 * weight_n) << "joint " << i;
    EXPECT_NEAR(force_n[2], tension_n[i], 1e-9 * weight_n) << "joint " << i;
    lowered_m += options.cfm * tension_n[i] * options.h_s / options.erp;
    EXPECT_NEAR(chain.state(i).position_m[2], -0.5 - i - lowered_m, 1e-9) << "link " << i;
  }
  EXPECT_EQ(chain.inexact_steps(), 0);
}

// --- stack: boxes on the ground

// Widths from below, m: all different, because of faces that coincide ODE keeps other corners each step.
class StackTest : public testing::TestWithParam<std::vector<double>> {};

// Forces between two boxes add up to the weight above; each of k contacts is compressed by cfm F h / (erp k).
TEST_P(StackTest, ContactsCarryTheWeightAndSagByTheirCompliance) {
  const std::vector<double>& edge_m = GetParam();
  const int boxes = static_cast<int>(edge_m.size());
  const auto mass_kg = [](int i) { return i % 2 == 0 ? 5.0 : 40.0; };
  auto world = make_world([&](SceneBuilder& builder) {
    builder.add_plane({0, 0, 1}, 0);
    double top_m = 0;
    for (int i = 0; i < boxes; ++i) {
      builder.add_box({{0, 0, top_m + 0.25}, {1, 0, 0, 0}}, mass_kg(i), {edge_m[i], edge_m[i], 0.5});
      top_m += 0.5 - 1e-6;
    }
  });
  ExtractOptions options;
  options.cfm = 1e-5;
  WorldStepper stack(std::move(world), options);
  stack.steps(600);

  double above_n = 0;
  for (int i = 0; i < boxes; ++i) above_n += mass_kg(i) * kGravity_m_per_s2;
  const double weight_n = above_n;
  double height_m = -0.25;
  for (int i = 0; i < boxes; ++i) {
    SCOPED_TRACE("box " + std::to_string(i));
    const std::vector<int> contacts = stack.constraints_between(i, i - 1);
    ASSERT_GE(contacts.size(), 4u);
    std::array<double, 3> force_n{};
    for (const int contact : contacts)
      for (int k = 0; k < 3; ++k) force_n[k] += stack.force_n(contact, i)[k];
    EXPECT_NEAR(force_n[0], 0, 1e-8 * weight_n);
    EXPECT_NEAR(force_n[1], 0, 1e-8 * weight_n);
    EXPECT_NEAR(force_n[2], above_n, 1e-8 * weight_n);
    const double sag_m = options.cfm * above_n * options.h_s / (options.erp * contacts.size());
    height_m += 0.5 - sag_m;
    EXPECT_NEAR(stack.state(i).position_m[2], height_m, 1e-9);
    EXPECT_GT(sag_m, 1e-6);
    above_n -= mass_kg(i) * kGravity_m_per_s2;
  }
  EXPECT_EQ(stack.inexact_steps(), 0);
}

INSTANTIATE_TEST_SUITE_P(ClosedForm, StackTest,
                         testing::Values(std::vector<double>{1}, std::vector<double>{1, 0.9, 0.8, 0.7, 0.6},
                                         std::vector<double>{1, 1.1, 1.2, 1.3}));

}  // namespace
}  // namespace cleave
