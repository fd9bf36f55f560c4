// The crane at rest against statics, and what it and the mixed site do when they move.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "harness/experiment/algorithms.h"
#include "tests/harness/world_stepper.h"

namespace cleave {
namespace {

constexpr double kGravity_m_per_s2 = 9.81;

WorldStepper make_stepper(const char* scene_name, const std::map<std::string, std::string>& given, double h_s,
                          double cfm) {
  for (const SceneEntry& scene : scenes()) {
    if (std::string(scene.name) != scene_name) continue;
    ExtractOptions options;
    options.h_s = h_s;
    options.cfm = cfm;
    return {std::make_unique<OdeWorld>(scene, make_scene_settings(scene, given), 1, kGravity_m_per_s2),
            options};
  }
  throw std::logic_error(scene_name);
}

// Mass, and moments of mass about the world's origin along x and y.
struct Weight {
  double kg = 0, x = 0, y = 0;
};

Weight weigh(const StepProblem& problem, const WorldStepper& stepper, int first_body) {
  Weight sum;
  for (int i = first_body; i < problem.body_count(); ++i) {
    const double kg = problem.mass[36 * i];
    const BodyState state = stepper.state(i);
    sum.kg += kg;
    sum.x += kg * state.position_m[0];
    sum.y += kg * state.position_m[1];
  }
  return sum;
}

class CraneAtRest : public testing::Test {
 protected:
  static constexpr int kLinks = 100;
  // What the joints give when the weight comes on them lets the boom and the load swing, without end and in
  // proportion.
  static constexpr double kCfm = 1e-12;
  static void SetUpTestSuite() {
    crane_ = new WorldStepper(make_stepper("crane", {{"slew", "0"}}, 0.001, kCfm));
    crane_->steps(400);
  }
  static void TearDownTestSuite() { delete crane_; }
  static WorldStepper* crane_;
};
WorldStepper* CraneAtRest::crane_ = nullptr;

// A ball joint of the cable carries what hangs below it.
TEST_F(CraneAtRest, TheCableCarriesWhatHangsBelow) {
  EXPECT_EQ(crane_->inexact_steps(), 0);
  const int bodies = crane_->problem().body_count(), load = bodies - 1;
  double worst = 0;
  for (int link = load - kLinks; link <= load; ++link) {
    const std::vector<int> joints = crane_->constraints_between(link - 1, link);
    ASSERT_EQ(joints.size(), 1u) << link;
    const double tension_n = crane_->force_n(joints[0], link)[2];
    const double hanging_n = weigh(crane_->problem(), *crane_, link).kg * kGravity_m_per_s2;
    EXPECT_NEAR(tension_n / hanging_n, 1, 1e-6) << "link " << link;
    worst = std::max(worst, std::abs(tension_n / hanging_n - 1));
  }
  std::printf("cable tension: relative error at most %.1e\n", worst);
}

// Four equal springs in the corners of a rectangle: with weight W at (x, y) off its middle the foot at (+-a,
// +-b) carries W (1 +- x / a +- y / b) / 4.
TEST_F(CraneAtRest, TheOutriggersCarryTheCrane) {
  const Weight all = weigh(crane_->problem(), *crane_, 0);
  double worst = 0, sum_n = 0;
  for (int leg = 1; leg <= 4; ++leg) {
    const std::vector<int> feet = crane_->constraints_between(leg, -1);
    ASSERT_EQ(feet.size(), 1u) << leg;
    const StepProblem& problem = crane_->problem();
    int row = 0;
    while (problem.row_constraint[row] != feet[0]) ++row;
    const double a = problem.contact_point[3 * row], b = problem.contact_point[3 * row + 1];
    const double expected_n = kGravity_m_per_s2 * (all.kg + all.x / a + all.y / b) / 4;
    const double load_n = crane_->force_n(feet[0], leg)[2];
    sum_n += load_n;
    EXPECT_NEAR(load_n / expected_n, 1, 1e-6) << "outrigger " << leg;
    EXPECT_GT(expected_n, 1e4) << "the crane stands on all of them";
    worst = std::max(worst, std::abs(load_n / expected_n - 1));
  }
  EXPECT_NEAR(sum_n / (all.kg * kGravity_m_per_s2), 1, 1e-6);
  EXPECT_GT(std::abs(all.x) + std::abs(all.y), 0.1 * all.kg) << "the weight is off the middle";
  std::printf("outriggers: relative error at most %.1e\n", worst);
}

// Slewing at 0.1 rad/s once the motor has brought it there, the joints hold and the load follows.
TEST(CraneMotion, Slews) {
  WorldStepper crane = make_stepper("crane", {{"mass-ratio", "400"}}, 0.005, 1e-10);
  crane.steps(600);
  EXPECT_EQ(crane.inexact_steps(), 0);
  const auto turntable = crane.state(5).velocity;
  EXPECT_NEAR(turntable[5], 0.1, 1e-3);
  const double turned_rad =
      2 * std::atan2(crane.state(5).orientation[3], crane.state(5).orientation[0]) - 0.5;
  std::printf("slewed by %.4f rad\n", turned_rad);
  EXPECT_GT(turned_rad, 0.15);
  EXPECT_LT(turned_rad, 0.3);
}

// The rock in the middle of the lowest layer, on the hook, is drawn out from under those that lie on it; then
// the crane slews with it.
TEST(CraneMotion, LiftsARockOutOfThePile) {
  WorldStepper site = make_stepper("mixed_site", {{"rings", "1"}, {"links", "50"}}, 0.001, 1e-10);
  site.step();
  // The rock, the middle one of 3 x 3, is joined to the last link before the pile's first rock.
  const int first_rock = site.problem().body_count() - 13, rock = first_rock + 4;
  ASSERT_EQ(site.constraints_between(first_rock - 1, rock).size(), 1u);
  double highest_m = 0;
  for (int step = 0; step < 1200; ++step) {
    site.step();
    highest_m = std::max(highest_m, site.state(rock).position_m[2]);
  }
  EXPECT_EQ(site.inexact_steps(), 0);
  std::printf("the rock rose to %.3f m\n", highest_m);
  EXPECT_GT(highest_m, 0.3 + 0.5);
}

}  // namespace
}  // namespace cleave
