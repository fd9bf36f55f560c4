// A whole pile against ODE: on every step the extracted problem, solved exactly, must give the velocities of
// dWorldStep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "harness/world/extract.h"
#include "tests/harness/dense_oracle.h"
#include "tests/harness/extract_test_scene.h"

namespace cleave {
namespace {

constexpr double kStep_s = 1.0 / 60;
constexpr double kErp = 0.2;
constexpr int kContactCap = 8;

void build_pit(dSpaceID space, SceneContent& content) {
  content.geoms.push_back(dCreatePlane(space, 0, 0, 1, 0));
  for (const double side : {-1.0, 1.0}) {
    content.geoms.push_back(dCreatePlane(space, -side, 0, 0, -1.1));
    content.geoms.push_back(dCreatePlane(space, 0, -side, 0, -1.1));
  }
}

// Twenty boxes of random shape and orientation on a jittered 2 x 2 x 5 grid above a square pit.
void build_pile(dWorldID world, dSpaceID space, SceneContent& content, TestRandom& random, double cfm) {
  dWorldSetERP(world, kErp);
  dWorldSetCFM(world, cfm);
  build_pit(space, content);
  for (int i = 0; i < 20; ++i) {
    const dBodyID body = dBodyCreate(world);
    const double x = random.uniform(0.5, 0.8), y = random.uniform(0.5, 0.8), z = random.uniform(0.5, 0.8);
    dMass mass;
    dMassSetBoxTotal(&mass, 100, x, y, z);
    dBodySetMass(body, &mass);
    const auto jitter = [&] { return random.uniform(-0.05, 0.05); };
    dBodySetPosition(body, (i % 2) - 0.5 + jitter(), (i / 2 % 2) - 0.5 + jitter(), 0.8 + i / 4 + jitter());
    set_random_orientation(body, random);
    const dGeomID geom = dCreateBox(space, x, y, z);
    dGeomSetBody(geom, body);
    content.bodies.push_back(body);
    content.geoms.push_back(geom);
  }
}

// ODE's own contact joints from the same contact points in the same order.
void create_contact_joints(const OdeWorld& world, const std::vector<ContactPoint>& contacts,
                           double mu_force_n, dJointGroupID group) {
  for (const ContactPoint& point : contacts) {
    dContact contact{};
    contact.surface.mode = 0;
    contact.surface.mu = mu_force_n;
    std::copy(point.position_m.begin(), point.position_m.end(), contact.geom.pos);
    std::copy(point.normal.begin(), point.normal.end(), contact.geom.normal);
    contact.geom.depth = point.depth_m;
    const auto& bodies = world.content().bodies;
    dJointAttach(dJointCreateContact(world.world(), group, &contact), bodies[point.body_a],
                 point.body_b < 0 ? nullptr : bodies[point.body_b]);
  }
}

struct PileCase {
  double friction_force_n;
  double cfm;
  bool with_extras;  // gyroscopic torque, a contact surface layer and capped push-out
};

class PileAgainstDWorldStep : public testing::TestWithParam<PileCase> {};

TEST_P(PileAgainstDWorldStep, EveryStepWithoutMessageAgrees) {
  const PileCase& pile = GetParam();
  constexpr std::uint64_t kSeed = 3;
  TestRandom random(kSeed);
  const auto world =
      make_test_world([&](dWorldID w, dSpaceID s, SceneContent& c) { build_pile(w, s, c, random, pile.cfm); },
                      9.81, pile.with_extras);
  if (pile.with_extras) {
    dWorldSetContactSurfaceLayer(world->world(), 0.002);
    dWorldSetContactMaxCorrectingVel(world->world(), 0.2);
  }
  ExtractOptions options{kStep_s, kErp, pile.cfm, FrictionModel::constant, 0, pile.friction_force_n};

  constexpr int kSteps = 120;
  const dJointGroupID group = dJointGroupCreate(0);
  int steps_with_messages = 0, most_rows = 0, most_iterations = 0;
  double largest_difference = 0;
  for (int step = 0; step < kSteps; ++step) {
    int cap_hits = 0;
    const std::vector<ContactPoint> contacts = world->collide(kContactCap, &cap_hits);
    const StepProblem problem = extract(*world, contacts, options, ContactMemory());
    const OracleSolution exact = solve_exactly(problem);
    ASSERT_LE(exact.residual, 1e-11) << "oracle, step " << step << ", rows " << problem.row_count();

    create_contact_joints(*world, contacts, pile.friction_force_n, group);
    world->take_message_count();
    dWorldStep(world->world(), kStep_s);
    dJointGroupEmpty(group);
    most_rows = std::max(most_rows, problem.row_count());
    most_iterations = std::max(most_iterations, exact.iterations);
    if (world->take_message_count() > 0) {
      ++steps_with_messages;
      continue;
    }
    const double difference = velocity_difference(*world, exact.velocity);
    largest_difference = std::max(largest_difference, difference);
    EXPECT_LE(difference, 1e-9) << "seed " << kSeed << ", step " << step << ", rows " << problem.row_count();
  }
  dJointGroupDestroy(group);
  std::printf(
      "friction %g N, cfm %g, extras %d: largest velocity difference %.2e, %d of %d steps with messages, up "
      "to %d rows, "
      "%d Newton iterations\n",
      pile.friction_force_n, pile.cfm, pile.with_extras, largest_difference, steps_with_messages, kSteps,
      most_rows, most_iterations);
  EXPECT_LT(steps_with_messages, kSteps / 10);
  EXPECT_GT(most_rows, pile.friction_force_n > 0 ? 150 : 50) << "the boxes must have piled up";
}

INSTANTIATE_TEST_SUITE_P(FrictionAndCompliance, PileAgainstDWorldStep,
                         testing::Values(PileCase{0, 1e-5, false}, PileCase{0, 1e-7, false},
                                         PileCase{200, 1e-5, false}, PileCase{200, 1e-7, false},
                                         PileCase{200, 1e-5, true}));

}  // namespace
}  // namespace cleave
