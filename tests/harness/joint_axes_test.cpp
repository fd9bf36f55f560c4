// What is set on any axis of any ODE joint type is seen: every type, every parameter group, every parameter.
#include "harness/world/joint_axes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "harness/world/extract.h"
#include "tests/harness/extract_test_scene.h"

namespace cleave {
namespace {

struct TypeCase {
  const char* name;
  int axes;
  dJointID (*create)(dWorldID world, dJointGroupID group);
  void (*set)(dJointID joint, int parameter, dReal value);  // null without axes
};

const TypeCase kTypes[] = {
    {"ball", 0, dJointCreateBall, nullptr},
    {"hinge", 1, dJointCreateHinge, dJointSetHingeParam},
    {"slider", 1, dJointCreateSlider, dJointSetSliderParam},
    {"fixed", 0, dJointCreateFixed, nullptr},
    {"universal", 2, dJointCreateUniversal, dJointSetUniversalParam},
    {"hinge2", 2, dJointCreateHinge2, dJointSetHinge2Param},
    {"angular motor", 3, dJointCreateAMotor, dJointSetAMotorParam},
    {"linear motor", 3, dJointCreateLMotor, dJointSetLMotorParam},
    {"prismatic-rotoide", 2, dJointCreatePR, dJointSetPRParam},
    {"prismatic-universal", 3, dJointCreatePU, dJointSetPUParam},
    {"piston", 2, dJointCreatePiston, dJointSetPistonParam},
};

struct ParameterCase {
  int parameter;
  double value;
  const char* feature;
};

const ParameterCase kParameters[] = {
    {dParamLoStop, -1, "limit"},       {dParamHiStop, 1, "limit"},
    {dParamFMax, 5, "motor"},          {dParamVel, 2, "motor"},
    {dParamBounce, 0.5, "bounce"},     {dParamFudgeFactor, 0.5, "fudge factor"},
    {dParamCFM, 0.125, "motor cfm"},   {dParamStopCFM, 0.125, "stop cfm"},
    {dParamStopERP, 0.75, "stop erp"},
};

using World = std::unique_ptr<std::remove_pointer_t<dWorldID>, decltype(&dWorldDestroy)>;

TEST(JointAxes, EveryParameterOfEveryAxisOfEveryTypeIsSeen) {
  ASSERT_EQ(dInitODE2(0), 1);
  const World world(dWorldCreate(), dWorldDestroy);
  int cases = 0;
  for (const TypeCase& type : kTypes) {
    const dJointID plain = type.create(world.get(), nullptr);
    EXPECT_EQ(find_axis_feature(world.get(), plain), "") << type.name;
    EXPECT_EQ(joint_type_name(dJointGetType(plain)), std::string(type.name));
    ASSERT_EQ(axis_count(dJointGetType(plain)), type.axes) << type.name;
    for (int axis = 0; axis < type.axes; ++axis)
      for (const ParameterCase& one : kParameters) {
        const dJointID joint = type.create(world.get(), nullptr);
        type.set(joint, dParamGroup * axis + one.parameter, one.value);
        EXPECT_EQ(find_axis_feature(world.get(), joint),
                  std::string(one.feature) + " on axis " + std::to_string(axis + 1))
            << type.name;
        ++cases;
      }
  }
  EXPECT_EQ(cases, 19 * 9);
}

// ODE's own list of types; a joint type that is new there has a row here, or the program does not compile.
TEST(JointAxes, EveryTypeHasItsOwnName) {
  std::vector<std::string> names;
  for (int type = dJointTypeNone; type <= dJointTypeTransmission; ++type)
    names.push_back(joint_type_name(static_cast<dJointType>(type)));
  EXPECT_EQ(names[dJointTypePU], "prismatic-universal");
  EXPECT_EQ(names[dJointTypeTransmission], "transmission");
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

// As extraction refuses it, for each kind whose rows are taken from ODE.
TEST(JointAxes, ExtractionRefusesWhatIsSetOnAnAxis) {
  int cases = 0;
  for (const TypeCase* type : {&kTypes[1], &kTypes[2]})
    for (const ParameterCase& one : kParameters) {
      const auto world = make_test_world(
          [&](dWorldID w, dSpaceID, SceneContent& content) {
            TestRandom random(1);
            add_random_body(w, content, random);
            add_random_body(w, content, random);
            const dJointID joint = type->create(w, nullptr);
            dJointAttach(joint, content.bodies[0], content.bodies[1]);
            type->set(joint, one.parameter, one.value);
            content.joints.push_back(joint);
          },
          9.81, true);
      try {
        extract(*world, {}, {}, ContactMemory());
        ADD_FAILURE() << "accepted " << one.feature << " on a " << type->name;
      } catch (const std::runtime_error& error) {
        EXPECT_EQ(error.what(), "joint 0: a " + std::string(one.feature) + " on axis 1 of a " + type->name +
                                    " joint is not extracted from ODE");
      }
      ++cases;
    }
  EXPECT_EQ(cases, 2 * 9);
}

}  // namespace
}  // namespace cleave
