// Two random bodies on a joint of a kind that is extracted, off the pose in which they were joined.
#pragma once

#include <functional>
#include <memory>

#include "harness/world/extract.h"
#include "tests/harness/extract_test_scene.h"

namespace cleave {

inline constexpr double kStep_s = 1.0 / 60;

enum class Attachment { two_bodies, body_then_static, static_then_body };
inline constexpr Attachment kAttachments[] = {Attachment::two_bodies, Attachment::body_then_static,
                                              Attachment::static_then_body};

struct JointCase {
  const char* name;
  int rows;
  dJointID (*create)(dWorldID world);
  void (*set_geometry)(dJointID joint, TestRandom& random);
};

inline void set_ball(dJointID joint, TestRandom& r) {
  dJointSetBallAnchor(joint, r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
}
inline void set_hinge(dJointID joint, TestRandom& r) {
  dJointSetHingeAnchor(joint, r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
  dJointSetHingeAxis(joint, r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
}
inline void set_slider(dJointID joint, TestRandom& r) {
  dJointSetSliderAxis(joint, r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
}
inline void set_fixed(dJointID joint, TestRandom&) { dJointSetFixed(joint); }

inline const JointCase kJointCases[] = {
    {"ball", 3, [](dWorldID w) { return dJointCreateBall(w, nullptr); }, set_ball},
    {"hinge", 5, [](dWorldID w) { return dJointCreateHinge(w, nullptr); }, set_hinge},
    {"slider", 5, [](dWorldID w) { return dJointCreateSlider(w, nullptr); }, set_slider},
    {"fixed", 6, [](dWorldID w) { return dJointCreateFixed(w, nullptr); }, set_fixed},
};

inline dJointID add_joint(dWorldID world, SceneContent& content, const JointCase& kind, Attachment attachment,
                          TestRandom& random) {
  const dJointID joint = kind.create(world);
  const dBodyID first = content.bodies.front(), last = content.bodies.back();
  if (attachment == Attachment::two_bodies) dJointAttach(joint, first, last);
  if (attachment == Attachment::body_then_static) dJointAttach(joint, last, nullptr);
  if (attachment == Attachment::static_then_body) dJointAttach(joint, nullptr, last);
  kind.set_geometry(joint, random);
  content.joints.push_back(joint);
  return joint;
}

// Two bodies joined at one pose, then moved off it: a position error in every row, `size` in metres and
// radians.
inline void displace(const SceneContent& content, TestRandom& random, double size) {
  for (const dBodyID body : content.bodies) {
    const dReal* x = dBodyGetPosition(body);
    const dReal* q = dBodyGetQuaternion(body);
    dQuaternion turned{q[0], q[1], q[2], q[3]};
    for (double& entry : turned) entry += random.uniform(-size, size);
    dBodySetPosition(body, x[0] + random.uniform(-size, size), x[1] + random.uniform(-size, size),
                     x[2] + random.uniform(-size, size));
    dBodySetQuaternion(body, turned);
  }
}

struct Softness {
  double erp = 0.2;
  double cfm = 1e-5;
};

inline std::unique_ptr<OdeWorld> make_joined_bodies(const JointCase& kind, Attachment attachment,
                                                    std::uint64_t seed, bool gyroscopic, Softness of_world,
                                                    const std::function<void(dJointID)>& change = {}) {
  return make_test_world(
      [=](dWorldID world, dSpaceID, SceneContent& content) {
        TestRandom random(seed);
        dWorldSetERP(world, of_world.erp);
        dWorldSetCFM(world, of_world.cfm);
        add_random_body(world, content, random);
        add_random_body(world, content, random);
        const dJointID joint = add_joint(world, content, kind, attachment, random);
        if (change) change(joint);
        displace(content, random, seed % 2 ? 0.05 : 0.6);
      },
      9.81, gyroscopic);
}

inline StepProblem extract_joints(const OdeWorld& world, Softness softness) {
  ExtractOptions options;
  options.h_s = kStep_s;
  options.erp = softness.erp;
  options.cfm = softness.cfm;
  return extract(world, {}, options, ContactMemory());
}

}  // namespace cleave
