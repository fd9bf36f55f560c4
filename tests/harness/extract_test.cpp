// Contact rows, row order, options and warm impulses of extract().
#include "harness/world/extract.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>

#include "tests/harness/extract_test_scene.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

Vector3d to_vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

// Overlapping random boxes around and in a static floor box, some of them joined by ball joints.
std::unique_ptr<OdeWorld> make_heap(std::uint64_t seed) {
  return make_test_world(
      [seed](dWorldID world, dSpaceID space, SceneContent& content) {
        TestRandom random(seed);
        for (int i = 0; i < 6; ++i) {
          const dBodyID body = add_random_body(world, content, random);
          content.geoms.push_back(dCreateBox(space, 0.8, 0.8, 0.8));
          dGeomSetBody(content.geoms.back(), body);
        }
        // Static geometry with the highest index, and a second geom on one body.
        content.geoms.push_back(dCreateBox(space, 4, 4, 1));
        content.geoms.push_back(dCreateSphere(space, 0.7));
        dGeomSetBody(content.geoms.back(), content.bodies[2]);
        for (const int i : {4, 1}) {
          content.joints.push_back(dJointCreateBall(world, nullptr));
          dJointAttach(content.joints.back(), content.bodies[i], content.bodies[i - 1]);
          dJointSetBallAnchor(content.joints.back(), 0, 0, 0);
        }
      },
      9.81, true);
}

TEST(Extract, ProblemsAreConsistent) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto world = make_heap(seed);
    const std::vector<ContactPoint> contacts = world->collide(8, nullptr);
    for (const FrictionModel model :
         {FrictionModel::none, FrictionModel::constant, FrictionModel::box, FrictionModel::box_converged,
          FrictionModel::cone, FrictionModel::coulomb}) {
      ExtractOptions options;
      options.friction = model;
      options.friction_force_n = 100;
      const StepProblem problem = extract(*world, contacts, options, ContactMemory());
      EXPECT_EQ(find_problem_error(problem), "") << "seed " << seed;
      EXPECT_GT(contacts.size(), 10u) << "seed " << seed;
      const std::size_t rows_per_contact = model == FrictionModel::none ? 1 : 3;
      EXPECT_EQ(problem.row_count(), static_cast<int>(6 + rows_per_contact * contacts.size()))
          << "seed " << seed;
    }
  }
}

// Joints by creation, then contacts by (lower body, other body or -1, lower geom, other geom); normal, t1,
// t2.
TEST(Extract, RowsFollowTheDocumentedOrder) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto world = make_heap(seed);
    const std::vector<ContactPoint> contacts = world->collide(8, nullptr);
    const StepProblem problem = extract(*world, contacts, {}, ContactMemory());
    const std::vector<int> ids = problem.row_constraint;
    EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end())) << "seed " << seed;
    EXPECT_EQ(std::vector<int>(ids.begin(), ids.begin() + 6), (std::vector<int>{0, 0, 0, 1, 1, 1}));
    EXPECT_EQ(problem.row_body[0], 4);
    EXPECT_EQ(problem.row_body[6], 1);

    std::tuple<int, int, int, int> previous{-1, -1, -1, -1};
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const int row = 6 + 3 * static_cast<int>(k);
      EXPECT_EQ(problem.row_kind[row], RowKind::normal);
      for (int side = 0; side < 3; ++side) {
        EXPECT_EQ(problem.row_constraint[row + side], 2 + static_cast<int>(k));
        EXPECT_EQ(problem.friction_row[row + side], side == 0 ? -1 : row);
        EXPECT_EQ(problem.row_body[2 * (row + side)], contacts[k].body_a);
        EXPECT_EQ(problem.row_body[2 * (row + side) + 1], contacts[k].body_b);
      }
      const ContactPoint& contact = contacts[k];
      const auto [low, high] = std::minmax(contact.geom_a, contact.geom_b);
      const int a = problem.row_body[2 * row], b = problem.row_body[2 * row + 1];
      const std::tuple<int, int, int, int> key{b < 0 ? a : std::min(a, b), b < 0 ? -1 : std::max(a, b), low,
                                               high};
      EXPECT_LE(previous, key) << "seed " << seed << ", contact " << k;
      previous = key;
    }
  }
}

TEST(Extract, ContactDirectionsAreAnOrthonormalFrame) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto world = make_heap(seed);
    const std::vector<ContactPoint> contacts = world->collide(8, nullptr);
    const StepProblem problem = extract(*world, contacts, {}, ContactMemory());
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      Eigen::Matrix3d frame;
      for (int side = 0; side < 3; ++side)
        frame.row(side) = Eigen::Map<const Eigen::RowVector3d>(&problem.jacobian[12 * (6 + 3 * k + side)]);
      EXPECT_LE((frame * frame.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
      EXPECT_NEAR(frame.determinant(), 1, 1e-14) << "right-handed: normal x t1 = t2";
      EXPECT_EQ(frame.row(0).transpose(), to_vector(contacts[k].normal));
    }
  }
}

// J u is the relative velocity of the touching points along each direction, from the velocities of rigid
// bodies.
TEST(Extract, JacobiansGiveRelativePointVelocities) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto world = make_heap(seed);
    const std::vector<ContactPoint> contacts = world->collide(8, nullptr);
    const StepProblem problem = extract(*world, contacts, {}, ContactMemory());
    const auto point_velocity = [&](int body, const Vector3d& point) -> Vector3d {
      if (body < 0) return Vector3d::Zero();
      const BodyState state = world->state(body);
      const Eigen::Map<const Vector3d> linear(state.velocity.data()), angular(state.velocity.data() + 3);
      return linear + angular.cross(point - to_vector(state.position_m));
    };
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const Vector3d point = to_vector(contacts[k].position_m);
      const Vector3d relative =
          point_velocity(contacts[k].body_a, point) - point_velocity(contacts[k].body_b, point);
      for (int side = 0; side < 3; ++side) {
        const int row = 6 + 3 * static_cast<int>(k) + side;
        double speed = 0;
        for (int end = 0; end < 2; ++end)
          if (const int body = problem.row_body[2 * row + end]; body >= 0)
            for (int j = 0; j < 6; ++j)
              speed += problem.jacobian[12 * row + 6 * end + j] * world->state(body).velocity[j];
        const Eigen::Map<const Vector3d> direction(&problem.jacobian[12 * row]);
        EXPECT_NEAR(speed, direction.dot(relative), 1e-12) << "seed " << seed << ", row " << row;
        EXPECT_EQ(Vector3d(Eigen::Map<const Vector3d>(&problem.contact_point[3 * row])), point);
      }
    }
  }
}

TEST(Extract, RightHandSidesAndCompliancesFollowTheFormulas) {
  const auto world = make_heap(1);
  const std::vector<ContactPoint> contacts = world->collide(8, nullptr);
  ExtractOptions options;
  options.h_s = 0.01;
  options.erp = 0.4;
  options.cfm = 3e-6;
  const StepProblem free_push = extract(*world, contacts, options, ContactMemory());
  dWorldSetContactSurfaceLayer(world->world(), 0.2);
  dWorldSetContactMaxCorrectingVel(world->world(), 1.5);
  const StepProblem capped = extract(*world, contacts, options, ContactMemory());
  bool was_capped = false, was_in_layer = false;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const int row = 6 + 3 * static_cast<int>(k);
    EXPECT_DOUBLE_EQ(free_push.rhs[row], 40 * contacts[k].depth_m);
    const double layered = 40 * std::max(0.0, contacts[k].depth_m - 0.2);
    EXPECT_DOUBLE_EQ(capped.rhs[row], std::min(1.5, layered));
    was_capped = was_capped || layered > 1.5;
    was_in_layer = was_in_layer || layered == 0;
    EXPECT_EQ(free_push.rhs[row + 1], 0);
    EXPECT_EQ(free_push.rhs[row + 2], 0);
    EXPECT_EQ(free_push.lower[row], 0);
    EXPECT_EQ(free_push.upper[row], std::numeric_limits<double>::infinity());
  }
  EXPECT_TRUE(was_capped && was_in_layer) << "the heap must exercise both";
  for (const double compliance : free_push.compliance) EXPECT_DOUBLE_EQ(compliance, 3e-4);
}

TEST(Extract, ModelsThatCarryNoFrictionBuildNoFrictionRows) {
  const auto world = make_heap(2);
  const std::vector<ContactPoint> contacts = world->collide(8, nullptr);
  ExtractOptions none;
  none.friction = FrictionModel::none;
  ExtractOptions no_force;
  no_force.friction = FrictionModel::constant;
  ExtractOptions smooth;
  smooth.mu = 0;
  for (const ExtractOptions& options : {none, no_force, smooth}) {
    const StepProblem problem = extract(*world, contacts, options, ContactMemory());
    EXPECT_EQ(problem.row_count(), 6 + static_cast<int>(contacts.size()));
  }
}

TEST(Extract, ContinuedContactsCarryTheirImpulsesAndBounds) {
  const auto world = make_heap(3);
  const std::vector<ContactPoint> contacts = world->collide(8, nullptr);
  ExtractOptions options;
  options.mu = 0.7;
  ContactMemory memory;
  const StepProblem cold = extract(*world, contacts, options, memory);
  for (const double impulse : cold.warm_impulse) EXPECT_EQ(impulse, 0);
  std::vector<double> impulse(cold.row_count());
  for (int r = 0; r < cold.row_count(); ++r) impulse[r] = 1 + r;
  memory.remember(contacts, cold, impulse);
  const StepProblem warm = extract(*world, contacts, options, memory);
  EXPECT_EQ(warm.warm_impulse, impulse);
  for (int r = 0; r < warm.row_count(); ++r) {
    if (warm.row_kind[r] != RowKind::friction) continue;
    EXPECT_EQ(warm.friction_coefficient[r], 0.7);
    EXPECT_DOUBLE_EQ(warm.upper[r], 0.7 * impulse[warm.friction_row[r]]);
    EXPECT_EQ(warm.lower[r], -warm.upper[r]);
  }
}

TEST(Extract, ConstantFrictionBoundsAreForceTimesStep) {
  const auto world = make_heap(3);
  ExtractOptions options;
  options.friction = FrictionModel::constant;
  options.friction_force_n = 120;
  const StepProblem problem = extract(*world, world->collide(8, nullptr), options, ContactMemory());
  for (int r = 0; r < problem.row_count(); ++r) {
    if (problem.row_kind[r] != RowKind::friction) continue;
    EXPECT_DOUBLE_EQ(problem.upper[r], 2);
    EXPECT_DOUBLE_EQ(problem.lower[r], -2);
    EXPECT_EQ(problem.friction_coefficient[r], 0) << "the bound follows no normal impulse";
  }
}

TEST(Extract, OptionsOutsideTheirRangeAreNamed) {
  const auto world = make_heap(1);
  const auto expect_named = [&](const char* name, double ExtractOptions::*member, double value) {
    ExtractOptions options;
    options.*member = value;
    try {
      extract(*world, {}, options, ContactMemory());
      ADD_FAILURE() << "accepted " << name << " = " << value;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).rfind(name, 0), 0u) << error.what();
    }
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  for (const double value : {0.0, -0.1, nan, infinity}) expect_named("h_s", &ExtractOptions::h_s, value);
  for (const double value : {-0.1, nan, infinity}) {
    expect_named("erp", &ExtractOptions::erp, value);
    expect_named("cfm", &ExtractOptions::cfm, value);
    expect_named("mu", &ExtractOptions::mu, value);
    expect_named("friction_force_n", &ExtractOptions::friction_force_n, value);
  }
}

TEST(Extract, WorldsWithoutBodiesOrConstraintsGiveEmptyProblems) {
  const auto empty = make_test_world([](dWorldID, dSpaceID, SceneContent&) {}, 9.81, true);
  EXPECT_EQ(extract(*empty, {}, {}, ContactMemory()).body_count(), 0);
  const auto one = make_test_world(
      [](dWorldID world, dSpaceID, SceneContent& content) {
        TestRandom random(1);
        add_random_body(world, content, random);
      },
      9.81, true);
  const StepProblem problem = extract(*one, {}, {}, ContactMemory());
  EXPECT_EQ(problem.body_count(), 1);
  EXPECT_EQ(problem.row_count(), 0);
  EXPECT_EQ(find_problem_error(problem), "");
}

}  // namespace
}  // namespace cleave
