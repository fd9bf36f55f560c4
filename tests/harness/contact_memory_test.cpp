// Matching on made-up contact lists, and what is remembered.
#include "harness/world/contact_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "tests/harness/extract_test_scene.h"

namespace cleave {
namespace {

// Geoms 0: plane, 1: box 0.5 x 2 x 2, 2: sphere of radius 0.5, 3: capsule of radius 0.1, 4: cylinder of
// radius 1 and length 0.3, 5: tetrahedron with edges of 0.4 along the axes.
std::unique_ptr<OdeWorld> make_shapes() {
  return make_test_world(
      [](dWorldID world, dSpaceID space, SceneContent& content) {
        content.geoms = {dCreatePlane(space, 0, 0, 1, 0), dCreateBox(space, 0.5, 2, 2),
                         dCreateSphere(space, 0.5), dCreateCapsule(space, 0.1, 3),
                         dCreateCylinder(space, 1, 0.3)};
        static const dReal planes[] = {-1, 0, 0,  0, 0,       -1,      0,       0,
                                       0,  0, -1, 0, 0.57735, 0.57735, 0.57735, 0.23094};
        static const dReal points[] = {0, 0, 0, 0.4, 0, 0, 0, 0.4, 0, 0, 0, 0.4};
        static const unsigned polygons[] = {3, 0, 3, 2, 3, 0, 1, 3, 3, 0, 2, 1, 3, 1, 2, 3};
        content.geoms.push_back(dCreateConvex(space, planes, 4, points, 4, polygons));
        for (std::size_t g = 1; g < content.geoms.size(); ++g) {
          content.bodies.push_back(dBodyCreate(world));
          dGeomSetBody(content.geoms[g], content.bodies.back());
        }
      },
      9.81, true);
}

ContactPoint make_contact(int geom_a, int geom_b, double x, double y = 0, double z = 0) {
  ContactPoint contact;
  contact.geom_a = geom_a;
  contact.geom_b = geom_b;
  contact.body_a = 0;
  contact.position_m = {x, y, z};
  contact.normal = {0, 0, 1};
  return contact;
}

// A problem with as many frictionless contacts and nothing else.
StepProblem make_contact_problem(std::size_t contacts) {
  StepProblem problem;
  for (std::size_t k = 0; k < contacts; ++k) {
    problem.row_kind.push_back(RowKind::normal);
    problem.row_constraint.push_back(static_cast<int>(k));
    problem.friction_row.push_back(-1);
    problem.rhs.push_back(0);
  }
  return problem;
}

ContactMemory remembering(const std::vector<ContactPoint>& contacts, double tolerance = 0.05) {
  ContactMemory memory(tolerance);
  memory.remember(contacts, make_contact_problem(contacts.size()), std::vector<double>(contacts.size(), 1.0));
  return memory;
}

TEST(ContactMemory, NothingIsRememberedAtFirst) {
  const auto world = make_shapes();
  const std::vector<ContactPoint> contacts{make_contact(1, 2, 0)};
  EXPECT_EQ(ContactMemory().match(*world, contacts), std::vector<int>{-1});
  EXPECT_TRUE(ContactMemory().joint_impulse(3).empty());
}

TEST(ContactMemory, ReachIsAFractionOfTheSmallerLeastExtent) {
  const auto world = make_shapes();
  struct Pair {
    int geom_a, geom_b;
    double least_extent_m;
  };
  for (const Pair& pair : {Pair{1, 0, 0.5}, Pair{2, 0, 1.0}, Pair{1, 2, 0.5}, Pair{3, 0, 0.2},
                           Pair{2, 3, 0.2}, Pair{4, 0, 0.3}, Pair{4, 3, 0.2}, Pair{5, 0, 0.4}}) {
    const ContactMemory memory = remembering({make_contact(pair.geom_a, pair.geom_b, 0)}, 0.1);
    const double reach_m = 0.1 * pair.least_extent_m;
    const std::vector<ContactPoint> within{make_contact(pair.geom_a, pair.geom_b, 0.999 * reach_m)};
    const std::vector<ContactPoint> beyond{make_contact(pair.geom_a, pair.geom_b, 1.001 * reach_m)};
    EXPECT_EQ(memory.match(*world, within), std::vector<int>{0}) << pair.geom_a << " " << pair.geom_b;
    EXPECT_EQ(memory.match(*world, beyond), std::vector<int>{-1}) << pair.geom_a << " " << pair.geom_b;
  }
}

TEST(ContactMemory, ZeroToleranceMatchesTheSamePointOnly) {
  const auto world = make_shapes();
  const ContactMemory memory = remembering({make_contact(1, 2, 0.25)}, 0);
  EXPECT_EQ(memory.match(*world, std::vector{make_contact(1, 2, 0.25)}), std::vector<int>{0});
  EXPECT_EQ(memory.match(*world, std::vector{make_contact(1, 2, 0.2500001)}), std::vector<int>{-1});
}

TEST(ContactMemory, OnlyContactsOfTheSamePairMatch) {
  const auto world = make_shapes();
  const ContactMemory memory = remembering({make_contact(1, 2, 0), make_contact(1, 0, 0)});
  EXPECT_EQ(memory.match(*world, std::vector{make_contact(2, 0, 0)}), std::vector<int>{-1});
  EXPECT_EQ(memory.match(*world, std::vector{make_contact(2, 1, 0)}), std::vector<int>{0})
      << "whichever comes first";
}

TEST(ContactMemory, NearestGoesFirstAndEachContactIsContinuedOnce) {
  const auto world = make_shapes();
  // Remembered 0 lies at 0 mm and 1 at 10 mm. Both 6 mm and 12 mm are nearest to 1; 12 mm is nearer, so 6 mm
  // gets 0.
  const ContactMemory memory = remembering({make_contact(1, 2, 0), make_contact(1, 2, 0.010)});
  EXPECT_EQ(memory.match(*world, std::vector{make_contact(1, 2, 0.006), make_contact(1, 2, 0.012)}),
            (std::vector<int>{0, 1}));
  EXPECT_EQ(memory.match(*world, std::vector{make_contact(1, 2, 0.006), make_contact(1, 2, 0.007),
                                             make_contact(1, 2, 0.008)}),
            (std::vector<int>{0, -1, 1}));
  // Ties: the lower present index first, then the lower remembered one.
  EXPECT_EQ(memory.match(*world, std::vector{make_contact(1, 2, 0.005), make_contact(1, 2, 0.005)}),
            (std::vector<int>{0, 1}));
}

std::vector<ContactPoint> random_contacts(TestRandom& random, int count) {
  std::vector<ContactPoint> contacts;
  for (int k = 0; k < count; ++k) {
    const int geom_a = 1 + random.below(3);
    contacts.push_back(make_contact(geom_a, random.below(geom_a), random.uniform(0, 0.06),
                                    random.uniform(0, 0.06), random.uniform(0, 0.06)));
  }
  return contacts;
}

// The rule itself, written as slowly as it reads: take the nearest allowed pair of unmatched contacts, again
// and again.
std::vector<int> slow_match(const std::vector<ContactPoint>& present,
                            const std::vector<ContactPoint>& remembered, double tolerance) {
  const double extent_m[] = {std::numeric_limits<double>::infinity(), 0.5, 1.0, 0.2};
  std::vector<int> continued(present.size(), -1);
  std::vector<bool> taken(remembered.size(), false);
  while (true) {
    double nearest = std::numeric_limits<double>::infinity();
    int best_present = -1, best_remembered = -1;
    for (std::size_t i = 0; i < present.size(); ++i)
      for (std::size_t j = 0; j < remembered.size(); ++j) {
        const ContactPoint &a = present[i], &b = remembered[j];
        if (continued[i] >= 0 || taken[j] || a.geom_a != b.geom_a || a.geom_b != b.geom_b) continue;
        double squared = 0;
        for (int k = 0; k < 3; ++k) squared += std::pow(a.position_m[k] - b.position_m[k], 2);
        const double distance = std::sqrt(squared);
        if (distance > tolerance * std::min(extent_m[a.geom_a], extent_m[a.geom_b]) || distance >= nearest)
          continue;
        nearest = distance;
        best_present = static_cast<int>(i);
        best_remembered = static_cast<int>(j);
      }
    if (best_present < 0) return continued;
    continued[best_present] = best_remembered;
    taken[best_remembered] = true;
  }
}

TEST(ContactMemory, AgreesWithTheSlowRuleInAnyOrder) {
  const auto world = make_shapes();
  int matched = 0, unmatched = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    TestRandom random(seed);
    const std::vector<ContactPoint> remembered = random_contacts(random, 25),
                                    present = random_contacts(random, 25);
    const ContactMemory memory = remembering(remembered, 0.05);
    const std::vector<int> continued = memory.match(*world, present);
    EXPECT_EQ(continued, slow_match(present, remembered, 0.05)) << "seed " << seed;

    std::vector<int> order(present.size());
    std::iota(order.begin(), order.end(), 0);
    for (int k = static_cast<int>(order.size()) - 1; k > 0; --k)
      std::swap(order[k], order[random.below(k + 1)]);
    std::vector<ContactPoint> shuffled;
    for (const int k : order) shuffled.push_back(present[k]);
    const std::vector<int> shuffled_continued = memory.match(*world, shuffled);
    for (std::size_t k = 0; k < order.size(); ++k) {
      EXPECT_EQ(shuffled_continued[k], continued[order[k]]) << "seed " << seed;
      ++(shuffled_continued[k] < 0 ? unmatched : matched);
    }
  }
  EXPECT_GT(matched, 500);
  EXPECT_GT(unmatched, 500);
}

TEST(ContactMemory, RemembersImpulsesByContactAndByJoint) {
  // Joint 1 with two rows, a contact with friction, a contact without.
  StepProblem problem;
  problem.row_kind = {RowKind::bilateral, RowKind::bilateral, RowKind::normal,
                      RowKind::friction,  RowKind::friction,  RowKind::normal};
  problem.row_constraint = {1, 1, 2, 2, 2, 3};
  problem.friction_row = {-1, -1, -1, 2, 2, -1};
  problem.rhs.assign(6, 0);
  ContactMemory memory;
  const std::vector<ContactPoint> contacts{make_contact(1, 2, 0), make_contact(1, 2, 1)};
  memory.remember(contacts, problem, std::vector<double>{10, 11, 12, 13, 14, 15});
  EXPECT_TRUE(memory.joint_impulse(0).empty());
  EXPECT_EQ(std::vector<double>(memory.joint_impulse(1).begin(), memory.joint_impulse(1).end()),
            (std::vector<double>{10, 11}));
  EXPECT_EQ(memory.contact_impulse(0), (std::array<double, 3>{12, 13, 14}));
  EXPECT_EQ(memory.contact_impulse(1), (std::array<double, 3>{15, 0, 0}));

  // A later step replaces all of it.
  memory.remember({}, StepProblem(), {});
  EXPECT_TRUE(memory.joint_impulse(1).empty());
  EXPECT_EQ(memory.match(*make_shapes(), contacts), (std::vector<int>{-1, -1}));
}

TEST(ContactMemory, ToleranceOutsideItsRangeIsRefused) {
  for (const double tolerance :
       {-0.01, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(ContactMemory memory(tolerance), std::invalid_argument);
}

}  // namespace
}  // namespace cleave
