// Joint rows: one step of each joint kind against dWorldStep, own softness, and refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "harness/world/extract.h"
#include "tests/harness/dense_oracle.h"
#include "tests/harness/extract_test_scene.h"
#include "tests/harness/joined_bodies.h"

namespace cleave {
namespace {

TEST(JointRows, OneStepOfEveryKindAgreesWithDWorldStep) {
  const Softness softness{0.3, 1e-5};
  for (const JointCase& kind : kJointCases) {
    double largest = 0;
    for (const Attachment attachment : kAttachments)
      for (const bool gyroscopic : {false, true})
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
          const auto world = make_joined_bodies(kind, attachment, seed, gyroscopic, softness);
          const StepProblem problem = extract_joints(*world, softness);
          ASSERT_EQ(problem.row_count(), kind.rows);
          const OracleSolution exact = solve_exactly(problem);
          ASSERT_LE(exact.residual, 1e-11) << kind.name << ", seed " << seed;
          dWorldStep(world->world(), kStep_s);
          const double difference = velocity_difference(*world, exact.velocity);
          EXPECT_LE(difference, 1e-10) << kind.name << ", attachment " << static_cast<int>(attachment)
                                       << ", gyroscopic " << gyroscopic << ", seed " << seed;
          largest = std::max(largest, difference);
        }
    std::printf("%s: largest velocity difference %.2e\n", kind.name, largest);
  }
}

TEST(JointRows, RowsAreBilateralWithTheDynamicBodyFirst) {
  for (const JointCase& kind : kJointCases)
    for (const Attachment attachment : kAttachments) {
      const auto world = make_joined_bodies(kind, attachment, 4, true, {});
      const StepProblem problem = extract_joints(*world, {});
      EXPECT_EQ(find_problem_error(problem), "") << kind.name;
      ASSERT_EQ(problem.row_count(), kind.rows);
      const bool joined = attachment == Attachment::two_bodies;
      for (int r = 0; r < kind.rows; ++r) {
        EXPECT_EQ(problem.row_body[2 * r], joined ? 0 : 1) << kind.name;
        EXPECT_EQ(problem.row_body[2 * r + 1], joined ? 1 : -1) << kind.name;
        EXPECT_EQ(problem.row_kind[r], RowKind::bilateral);
        EXPECT_EQ(problem.lower[r], -std::numeric_limits<double>::infinity());
        EXPECT_EQ(problem.upper[r], std::numeric_limits<double>::infinity());
        EXPECT_EQ(problem.compliance[r], 1e-5 / kStep_s);
        EXPECT_EQ(problem.row_constraint[r], 0);
        EXPECT_EQ(problem.friction_row[r], -1);
      }
    }
}

// The error of a row, h b / erp, must fall at the rate J v: checked by moving the bodies a little from a
// satisfied pose.
TEST(JointRows, ErrorsAreDifferentiatedByTheJacobian) {
  for (const JointCase& kind : kJointCases)
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const auto world = make_test_world(
          [&](dWorldID w, dSpaceID, SceneContent& content) {
            TestRandom random(seed);
            add_random_body(w, content, random);
            add_random_body(w, content, random);
            add_joint(w, content, kind, Attachment::two_bodies, random);
            // A slider's rows take the mean of two angular velocities that its other rows make equal.
            const dReal* omega = dBodyGetAngularVel(content.bodies[0]);
            if (kind.set_geometry == set_slider)
              dBodySetAngularVel(content.bodies[1], omega[0], omega[1], omega[2]);
          },
          0, false);
      const StepProblem before = extract_joints(*world, {});
      constexpr double kMove_s = 1e-6;
      world->advance(before.free_velocity, kMove_s);
      const StepProblem after = extract_joints(*world, {});
      for (int r = 0; r < kind.rows; ++r) {
        double rate = 0;
        for (int k = 0; k < 12; ++k) rate += before.jacobian[12 * r + k] * before.free_velocity[k];
        const double change = (after.rhs[r] - before.rhs[r]) * kStep_s / 0.2;
        EXPECT_NEAR(before.rhs[r], 0, 1e-12) << kind.name << ", row " << r << ", seed " << seed;
        EXPECT_NEAR(change / kMove_s, -rate, 2e-4) << kind.name << ", row " << r << ", seed " << seed;
      }
    }
}

// What a ball or fixed joint was given of its own is kept; what it was not is the step's, whatever the world
// held.
TEST(JointRows, OwnSoftnessIsKeptAndUnsetSoftnessIsTheSteps) {
  const Softness step{0.35, 1e-4};
  const auto set_own = [](dJointID joint) {
    if (dJointGetType(joint) == dJointTypeBall) {
      dJointSetBallParam(joint, dParamERP, 0.7);
      dJointSetBallParam(joint, dParamCFM, 3e-3);
    } else {
      dJointSetFixedParam(joint, dParamERP, 0.7);
      dJointSetFixedParam(joint, dParamCFM, 3e-3);
    }
  };
  for (const JointCase* kind : {&kJointCases[0], &kJointCases[3]})
    for (const bool own : {false, true})
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const auto change = own ? std::function<void(dJointID)>(set_own) : nullptr;
        OracleSolution exact;
        {
          const auto ours =
              make_joined_bodies(*kind, Attachment::two_bodies, seed, true, {0.2, 1e-10}, change);
          exact = solve_exactly(extract_joints(*ours, step));
          // Extraction lends the joint the step's values only while it reads the rows.
          const dJointID joint = ours->content().joints[0];
          const bool ball = dJointGetType(joint) == dJointTypeBall;
          EXPECT_EQ((ball ? dJointGetBallParam : dJointGetFixedParam)(joint, dParamERP), own ? 0.7 : 0.2);
          EXPECT_EQ((ball ? dJointGetBallParam : dJointGetFixedParam)(joint, dParamCFM), own ? 3e-3 : 1e-10);
        }
        const auto ode = make_joined_bodies(*kind, Attachment::two_bodies, seed, true, step, change);
        dWorldStep(ode->world(), kStep_s);
        EXPECT_LE(velocity_difference(*ode, exact.velocity), 1e-10)
            << kind->name << ", own " << own << ", seed " << seed;
      }
}

TEST(JointRows, WarmImpulsesFollowTheJointWhenAnotherIsDisabled) {
  const auto world = make_test_world(
      [](dWorldID w, dSpaceID, SceneContent& content) {
        TestRandom random(2);
        for (int i = 0; i < 3; ++i) add_random_body(w, content, random);
        add_joint(w, content, kJointCases[0], Attachment::two_bodies, random);
        add_joint(w, content, kJointCases[3], Attachment::body_then_static, random);
      },
      9.81, true);
  ContactMemory memory;
  const StepProblem problem = extract_joints(*world, {});
  ASSERT_EQ(problem.row_count(), 9);
  std::vector<double> impulse(9);
  for (int r = 0; r < 9; ++r) impulse[r] = 10 + r;
  memory.remember({}, problem, impulse);

  EXPECT_EQ(extract(*world, {}, {}, memory).warm_impulse, impulse);
  dJointDisable(world->content().joints[0]);
  const StepProblem without_ball = extract(*world, {}, {}, memory);
  EXPECT_EQ(without_ball.warm_impulse, std::vector<double>(impulse.begin() + 3, impulse.end()));
  EXPECT_EQ(without_ball.row_constraint, std::vector<int>(6, 1));
}

// --- refusals -------------------------------------------------------------------------------------------

void expect_refused(const std::function<void(dWorldID, SceneContent&)>& add, const std::string& named) {
  const auto world = make_test_world(
      [&](dWorldID w, dSpaceID, SceneContent& content) {
        TestRandom random(1);
        add_random_body(w, content, random);
        add_random_body(w, content, random);
        add(w, content);
      },
      9.81, true);
  try {
    extract_joints(*world, {});
    ADD_FAILURE() << "accepted " << named;
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
  }
}

TEST(JointRows, OtherTypesAreRefusedByName) {
  const std::pair<const char*, dJointID (*)(dWorldID, dJointGroupID)> types[] = {
      {"universal", dJointCreateUniversal},       {"hinge2", dJointCreateHinge2},
      {"angular motor", dJointCreateAMotor},      {"linear motor", dJointCreateLMotor},
      {"plane2d", dJointCreatePlane2D},           {"prismatic-rotoide", dJointCreatePR},
      {"prismatic-universal", dJointCreatePU},    {"piston", dJointCreatePiston},
      {"double ball", dJointCreateDBall},         {"double hinge", dJointCreateDHinge},
      {"transmission", dJointCreateTransmission}, {"null", dJointCreateNull},
  };
  for (const auto& [name, create] : types) {
    expect_refused(
        [create = create](dWorldID w, SceneContent& content) {
          const dJointID joint = create(w, nullptr);
          const bool needs_static = dJointGetType(joint) == dJointTypePlane2D;
          dJointAttach(joint, content.bodies[0], needs_static ? nullptr : content.bodies[1]);
          content.joints.push_back(joint);
        },
        name);
  }
}

TEST(JointRows, UnlistedJointsAndBodiesAreRefusedByName) {
  expect_refused(
      [](dWorldID w, SceneContent& content) {
        TestRandom random(3);
        add_joint(w, content, kJointCases[1], Attachment::two_bodies, random);
        content.joints.clear();
      },
      "hinge joint is not among the scene's joints");
  expect_refused(
      [](dWorldID w, SceneContent& content) {
        TestRandom random(3);
        add_joint(w, content, kJointCases[0], Attachment::two_bodies, random);
        dJointAttach(content.joints[0], content.bodies[0], dBodyCreate(w));
      },
      "not among the scene's bodies");
}

}  // namespace
}  // namespace cleave
