// ODE worlds built by a function of the test, and seeded numbers whose values do not depend on the standard
// library.
#pragma once

#include <ode/ode.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <utility>

#include "harness/world/ode_world.h"
#include "scenarios/scene.h"

namespace cleave {

class TestRandom {
 public:
  explicit TestRandom(std::uint64_t seed) : generator_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_() >> 11) * 0x1p-53;
  }
  int below(int count) { return static_cast<int>(generator_() % static_cast<std::uint64_t>(count)); }

 private:
  std::mt19937_64 generator_;
};

using ContentMaker = std::function<void(dWorldID, dSpaceID, SceneContent&)>;

// SceneEntry::make is a plain function, so the maker of the world under construction waits here.
inline ContentMaker& pending_maker() {
  static ContentMaker maker;
  return maker;
}

class ExtractTestScene : public Scene {
 public:
  SceneContent build(dWorldID world, dSpaceID space, const Settings&, std::uint64_t) override {
    SceneContent content;
    pending_maker()(world, space, content);
    return content;
  }
};

inline std::unique_ptr<OdeWorld> make_test_world(ContentMaker maker, double gravity_m_per_s2,
                                                 bool gyroscopic) {
  pending_maker() = std::move(maker);
  const SceneEntry entry{{"test", "", ""},
                         [] { return std::unique_ptr<Scene>(std::make_unique<ExtractTestScene>()); }};
  return std::make_unique<OdeWorld>(entry, Settings(), 1, gravity_m_per_s2, gyroscopic);
}

inline void set_random_orientation(dBodyID body, TestRandom& random) {
  dQuaternion q;
  for (double& entry : q) entry = random.uniform(-1, 1);
  dBodySetQuaternion(body, q);  // normalises
}

inline void set_random_velocity(dBodyID body, TestRandom& random, double linear_m_per_s,
                                double angular_rad_per_s) {
  const auto entry = [&](double size) { return random.uniform(-size, size); };
  dBodySetLinearVel(body, entry(linear_m_per_s), entry(linear_m_per_s), entry(linear_m_per_s));
  dBodySetAngularVel(body, entry(angular_rad_per_s), entry(angular_rad_per_s), entry(angular_rad_per_s));
}

// A free body of random mass, inertia, place, orientation and velocity.
inline dBodyID add_random_body(dWorldID world, SceneContent& content, TestRandom& random) {
  const dBodyID body = dBodyCreate(world);
  dMass mass;
  dMassSetBoxTotal(&mass, random.uniform(0.5, 20), random.uniform(0.2, 1), random.uniform(0.2, 1),
                   random.uniform(0.2, 1));
  dBodySetMass(body, &mass);
  dBodySetPosition(body, random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  set_random_orientation(body, random);
  set_random_velocity(body, random, 3, 5);
  content.bodies.push_back(body);
  return body;
}

// Largest difference between the bodies' velocities in ODE and the given ones (n, 6).
template <typename Velocities>
double velocity_difference(const OdeWorld& world, const Velocities& velocity) {
  double largest = 0;
  for (int i = 0; i < world.body_count(); ++i) {
    const dReal* linear = dBodyGetLinearVel(world.content().bodies[i]);
    const dReal* angular = dBodyGetAngularVel(world.content().bodies[i]);
    for (int k = 0; k < 3; ++k) {
      // A NaN must not compare as small.
      const double linear_difference = std::abs(linear[k] - velocity[6 * i + k]);
      const double angular_difference = std::abs(angular[k] - velocity[6 * i + 3 + k]);
      if (!(linear_difference <= largest)) largest = linear_difference;
      if (!(angular_difference <= largest)) largest = angular_difference;
    }
  }
  return largest;
}

}  // namespace cleave
