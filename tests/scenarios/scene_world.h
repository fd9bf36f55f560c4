// A scene in a bare ODE world, stepped by ODE itself: enough to look at a scene without the harness.
#pragma once

#include <gtest/gtest.h>
#include <ode/ode.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <map>
#include <memory>
#include <string>

#include "scenarios/scene.h"

namespace cleave {

inline const SceneEntry& scene_named(const std::string& name) {
  for (const SceneEntry& scene : scenes())
    if (name == scene.name) return scene;
  throw std::logic_error("no scene " + name);
}

class SceneWorld {
 public:
  struct Contacts {
    int all = 0;
    int between_bodies = 0;
    double largest_depth_m = 0;
  };

  SceneWorld(const SceneEntry& entry, const std::map<std::string, std::string>& given, std::uint64_t seed = 1)
      : scene_(entry.make()) {
    static const int initialised = dInitODE2(0);
    EXPECT_NE(initialised, 0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    dSetMessageHandler([](int, const char*, std::va_list) {});
    dRandSetSeed(1);
    world_ = dWorldCreate();
    space_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
    contact_joints_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, 0, 0, -9.81);
    dWorldSetERP(world_, 0.2);
    dWorldSetCFM(world_, 1e-5);
    content_ = scene_->build(world_, space_, make_scene_settings(entry, given), seed);
  }
  SceneWorld(const SceneWorld&) = delete;
  ~SceneWorld() {
    dJointGroupDestroy(contact_joints_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  const SceneContent& content() const { return content_; }

  // Bodies joined by a joint do not collide.
  Contacts collide() {
    contacts_ = {};
    dJointGroupEmpty(contact_joints_);
    dSpaceCollide(space_, this, &SceneWorld::near);
    return contacts_;
  }

  // One QuickStep of 1/60 s with mu 0.5.
  Contacts step(int number, int iterations) {
    scene_->before_step(number, content_);
    const Contacts contacts = collide();
    dWorldSetQuickStepNumIterations(world_, iterations);
    dWorldQuickStep(world_, 1.0 / 60);
    return contacts;
  }

 private:
  static void near(void* self, dGeomID a, dGeomID b) { static_cast<SceneWorld*>(self)->add_contacts(a, b); }

  void add_contacts(dGeomID a, dGeomID b) {
    const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    const bool both = body_a != nullptr && body_b != nullptr;
    if (body_a == body_b || (both && dAreConnectedExcluding(body_a, body_b, dJointTypeContact))) return;
    dContact found[8];
    const int count = dCollide(a, b, 8, &found[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      found[i].surface.mode = dContactApprox1;
      found[i].surface.mu = 0.5;
      dJointAttach(dJointCreateContact(world_, contact_joints_, &found[i]), body_a, body_b);
      contacts_.largest_depth_m = std::max<double>(contacts_.largest_depth_m, found[i].geom.depth);
    }
    contacts_.all += count;
    contacts_.between_bodies += both ? count : 0;
  }

  std::unique_ptr<Scene> scene_;
  dWorldID world_ = nullptr;
  dSpaceID space_ = nullptr;
  dJointGroupID contact_joints_ = nullptr;
  SceneContent content_;
  Contacts contacts_;
};

inline double speed_m_per_s(dBodyID body) {
  const dReal* v = dBodyGetLinearVel(body);
  return std::sqrt(dCalcVectorDot3(v, v));
}

inline double highest_m(const SceneContent& content) {
  double z = 0;
  for (const dBodyID body : content.bodies) z = std::max<double>(z, dBodyGetPosition(body)[2]);
  return z;
}

}  // namespace cleave
