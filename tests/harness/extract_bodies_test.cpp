// Mass blocks, free velocities and gyroscopic torque against ODE's own free flight.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <stdexcept>
#include <string>

#include "harness/world/body_terms.h"
#include "tests/harness/extract_test_scene.h"

namespace cleave {
namespace {

constexpr double kStep_s = 1.0 / 60;

std::unique_ptr<OdeWorld> make_flying_bodies(std::uint64_t seed, bool gyroscopic) {
  return make_test_world(
      [seed](dWorldID world, dSpaceID, SceneContent& content) {
        TestRandom random(seed);
        for (int i = 0; i < 5; ++i) {
          const dBodyID body = add_random_body(world, content, random);
          set_random_velocity(body, random, 5, 20);
          dBodyAddForce(body, random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50));
          dBodyAddTorque(body, random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5));
          dBodySetGravityMode(body, random.below(2));
        }
      },
      9.81, gyroscopic);
}

TEST(BodyTerms, FreeFlightAgreesWithDWorldStep) {
  for (const bool gyroscopic : {false, true}) {
    double largest = 0;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      const auto world = make_flying_bodies(seed, gyroscopic);
      StepProblem problem;
      append_body_terms(*world, kStep_s, problem);
      dWorldStep(world->world(), kStep_s);
      const double difference = velocity_difference(*world, problem.free_velocity);
      EXPECT_LE(difference, 1e-13) << "seed " << seed << ", gyroscopic " << gyroscopic;
      largest = std::max(largest, difference);
    }
    std::printf("gyroscopic %d: largest velocity difference %.2e\n", gyroscopic, largest);
  }
}

TEST(BodyTerms, GyroscopicTorqueMattersInThatTest) {
  const auto with = make_flying_bodies(1, true);
  StepProblem gyroscopic, plain;
  append_body_terms(*with, kStep_s, gyroscopic);
  const auto without = make_flying_bodies(1, false);
  append_body_terms(*without, kStep_s, plain);
  EXPECT_GT(velocity_difference(*without, plain.free_velocity), 1e-3);  // forces act
  double largest = 0;
  for (std::size_t k = 0; k < plain.free_velocity.size(); ++k)
    largest = std::max(largest, std::abs(plain.free_velocity[k] - gyroscopic.free_velocity[k]));
  EXPECT_GT(largest, 0.1);
}

TEST(BodyTerms, MassBlocksGiveTheKineticEnergyOfTheBodies) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto world = make_flying_bodies(seed, true);
    StepProblem problem;
    append_body_terms(*world, kStep_s, problem);
    ASSERT_EQ(problem.body_count(), world->body_count());
    ASSERT_EQ(static_cast<int>(problem.mass.size()), 36 * world->body_count());
    double energy_j = 0;
    for (int i = 0; i < problem.body_count(); ++i) {
      const Eigen::Map<const Eigen::Matrix<double, 6, 6>> block(&problem.mass[36 * i]);
      const BodyState state = world->state(i);
      const Eigen::Map<const Eigen::Matrix<double, 6, 1>> u(state.velocity.data());
      energy_j += 0.5 * u.dot(block * u);
      EXPECT_EQ(block, block.transpose()) << "seed " << seed;
    }
    EXPECT_NEAR(energy_j, world->kinetic_energy_j(), 1e-12 * energy_j) << "seed " << seed;
  }
}

// The step is implicit in omega with the momentum held: I (w' - w) / h = -w' x L.
TEST(BodyTerms, GyroscopicTorqueSolvesItsImplicitEquation) {
  TestRandom random(5);
  for (int k = 0; k < 200; ++k) {
    const double h_s = random.uniform(1e-4, 0.1);
    Eigen::Matrix3d factor;
    Eigen::Vector3d omega;
    for (double& entry : factor.reshaped()) entry = random.uniform(-1, 1);
    for (double& entry : omega) entry = random.uniform(-30, 30);
    const Eigen::Matrix3d inertia = factor * factor.transpose() + 0.1 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d torque = implicit_gyroscopic_torque(inertia, omega, h_s);
    const Eigen::Vector3d next_omega = omega + h_s * inertia.inverse() * torque;
    const Eigen::Vector3d expected = -next_omega.cross(inertia * omega);
    EXPECT_LE((torque - expected).norm(), 1e-11 * (1 + expected.norm() + inertia.norm() * omega.norm() / h_s))
        << "case " << k;
    // It never adds energy, which is what the explicit torque -w x L does.
    EXPECT_LE(next_omega.dot(inertia * next_omega), omega.dot(inertia * omega) * (1 + 1e-12)) << "case " << k;
  }
}

void expect_refused(const ContentMaker& maker, const std::string& feature) {
  const auto world = make_test_world(maker, 9.81, true);
  StepProblem problem;
  try {
    append_body_terms(*world, kStep_s, problem);
    ADD_FAILURE() << "accepted " << feature;
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("body 1"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(feature), std::string::npos) << error.what();
  }
}

TEST(BodyTerms, SettingsThatAreNotExtractedAreRefusedByName) {
  const auto with = [](void (*change)(dBodyID)) {
    return [change](dWorldID world, dSpaceID, SceneContent& content) {
      TestRandom random(1);
      add_random_body(world, content, random);
      change(add_random_body(world, content, random));
    };
  };
  expect_refused(with(dBodySetKinematic), "kinematic");
  expect_refused(with(dBodyDisable), "disabled");
  expect_refused(with([](dBodyID body) { dBodySetLinearDamping(body, 0.1); }), "linear damping");
  expect_refused(with([](dBodyID body) { dBodySetAngularDamping(body, 0.1); }), "angular damping");
  expect_refused(with([](dBodyID body) { dBodySetMaxAngularSpeed(body, 5); }), "angular speed");
}

}  // namespace
}  // namespace cleave
