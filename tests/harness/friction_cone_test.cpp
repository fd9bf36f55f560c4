// Contacts of any problem under another friction model, there and back.
#include "harness/experiment/friction_cone.h"

#include <gtest/gtest.h>

#include <limits>

#include "harness/experiment/friction.h"
#include "harness/experiment/friction_box.h"
#include "solver/problem_hash.h"
#include "tests/harness/extract_test_scene.h"
#include "tests/harness/problem_file_sample.h"

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr ContactSet kCurved[] = {ContactSet::cone, ContactSet::coulomb};

// Two tangents a contact, as extraction makes them, with impulses carried over.
StepProblem make_extracted(double mu = 0.5) {
  const auto world = make_test_world(
      [](dWorldID world, dSpaceID space, SceneContent& content) {
        content.geoms.push_back(dCreatePlane(space, 0, 0, 1, 0));
        for (int i = 0; i < 2; ++i) {
          const dBodyID body = dBodyCreate(world);
          dBodySetPosition(body, 0.1 * i, 0, 0.199 + 0.398 * i);
          content.bodies.push_back(body);
          content.geoms.push_back(dCreateBox(space, 0.6, 0.6, 0.4));
          dGeomSetBody(content.geoms.back(), body);
        }
      },
      9.81, true);
  ExtractOptions options;
  options.mu = mu;
  StepProblem problem = extract(*world, world->collide(8, nullptr), options, ContactMemory());
  TestRandom random(5);
  for (double& impulse : problem.warm_impulse) impulse = random.uniform(-2, 8);
  return problem;
}

// Equal in every array but those of the friction model.
void expect_same_rest(StepProblem a, StepProblem b) {
  for (StepProblem* problem : {&a, &b}) {
    problem->contact_set.clear();
    for (int r = 0; r < problem->row_count(); ++r)
      if (problem->row_kind[r] == RowKind::friction) problem->lower[r] = problem->upper[r] = 0;
  }
  EXPECT_EQ(problem_hash(a), problem_hash(b));
}

TEST(FrictionCone, EveryContactHasTheSetAndNoBounds) {
  for (const ContactSet set : kCurved) {
    for (StepProblem problem : {make_extracted(), sample_problem(5, 1)}) {  // of two tangents, of one
      const StepProblem before = problem;
      (set == ContactSet::cone ? set_cones : set_coulomb)(problem);
      EXPECT_EQ(find_problem_error(problem), "");
      for (int r = 0; r < problem.row_count(); ++r) {
        const bool is_normal = problem.row_kind[r] == RowKind::normal;
        EXPECT_EQ(problem.contact_set[r], is_normal ? set : ContactSet::box);
        if (problem.row_kind[r] != RowKind::friction) continue;
        EXPECT_EQ(problem.lower[r], -kInfinity);
        EXPECT_EQ(problem.upper[r], kInfinity);
        EXPECT_FALSE(has_frozen_bound(problem, r));
      }
      expect_same_rest(problem, before);
      StepProblem turned = before;
      EXPECT_EQ(turn_contacts(set, turned), "");
      EXPECT_EQ(problem_hash(turned), problem_hash(problem));
      EXPECT_EQ(turn_contacts(set, turned), "");
      EXPECT_EQ(problem_hash(turned), problem_hash(problem)) << "once is as good as twice";
    }
  }
}

// Golden rows hold the hashes of problems without sets.
TEST(FrictionCone, HashesDifferByTheSet) {
  StepProblem problem = make_extracted();
  set_cones(problem);
  const std::uint64_t cone = problem_hash(problem);
  set_coulomb(problem);
  EXPECT_NE(problem_hash(problem), cone);
}

TEST(FrictionCone, BackToTheBoxesOfExtraction) {
  for (const ContactSet set : kCurved) {
    StepProblem boxes = make_extracted(), turned = boxes;
    predict_friction_bounds(boxes);
    ASSERT_EQ(turn_contacts(set, turned), "");
    ASSERT_EQ(turn_contacts(ContactSet::box, turned), "");
    EXPECT_EQ(problem_hash(turned), problem_hash(boxes));
  }
}

TEST(FrictionCone, BoxesStayAsTheyAre) {
  StepProblem problem = make_extracted();
  for (int r = 0; r < problem.row_count(); ++r)
    if (problem.row_kind[r] == RowKind::friction) problem.lower[r] = -(problem.upper[r] = 0.1 * r);
  const StepProblem before = problem;
  EXPECT_EQ(turn_contacts(ContactSet::box, problem), "");
  EXPECT_EQ(problem_hash(problem), problem_hash(before));
  // Also those beside a cone.
  problem.contact_set.assign(problem.row_count(), ContactSet::box);
  problem.contact_set[0] = ContactSet::cone;
  for (int r = 1; r < 3; ++r) problem.lower[r] = -(problem.upper[r] = kInfinity);
  ASSERT_EQ(find_problem_error(problem), "");
  EXPECT_EQ(turn_contacts(ContactSet::box, problem), "");
  EXPECT_TRUE(problem.contact_set.empty());
  for (int r = 3; r < problem.row_count(); ++r) EXPECT_EQ(problem.upper[r], before.upper[r]);
  for (int r = 1; r < 3; ++r) EXPECT_LT(problem.upper[r], kInfinity);
}

TEST(FrictionCone, ContactsThatCannotHaveASetAreNamed) {
  const auto error = [](auto change) {
    StepProblem problem = make_extracted();
    for (int r : {1, 2}) problem.lower[r] = -(problem.upper[r] = 1);
    change(problem);
    EXPECT_EQ(find_problem_error(problem), "") << "sound as boxes";
    return turn_contacts(ContactSet::cone, problem);
  };
  EXPECT_EQ(error([](StepProblem&) {}), "");
  EXPECT_TRUE(error([](StepProblem& p) {
                p.friction_coefficient[1] = 0;
              }).starts_with("friction_coefficient[1] = 0 with bounds -"));
  EXPECT_TRUE(error([](StepProblem& p) {
                p.friction_coefficient[2] = 0.25;
              }).starts_with("friction_coefficient[2] = 0.25, allowed: that of the row before"));
  EXPECT_TRUE(error([](StepProblem& p) { p.lower[0] = -1; }).starts_with("lower[0] = -1, allowed: 0"));
  EXPECT_TRUE(error([](StepProblem& p) {
                std::swap(p.friction_row[1], p.friction_row[4]);
                p.friction_row[4] = 0, p.friction_row[1] = 0, p.friction_row[5] = 0;
              }).starts_with("friction_row[4] = 0, allowed: another row"));
}

// Rows along which nothing may move, with coefficient 0, are no friction.
TEST(FrictionCone, LocksWithoutCoefficientStay) {
  StepProblem problem = make_extracted();
  for (int r = 1; r < 3; ++r) problem.friction_coefficient[r] = problem.lower[r] = problem.upper[r] = 0;
  EXPECT_EQ(turn_contacts(ContactSet::coulomb, problem), "");
  EXPECT_EQ(problem.contact_set[0], ContactSet::box);
  EXPECT_EQ(problem.contact_set[3], ContactSet::coulomb);
  EXPECT_EQ(problem.upper[1], 0);
}

TEST(FrictionCone, NoFrictionIsNoCone) {
  for (const ContactSet set : kCurved) {
    StepProblem problem = make_extracted(0);
    EXPECT_EQ(turn_contacts(set, problem), "");
    EXPECT_TRUE(problem.contact_set.empty());
  }
}

}  // namespace
}  // namespace cleave
