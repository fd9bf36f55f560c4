// One ODE world with its scene: owns everything in it, finds contacts, counts ODE's messages, reads and
// writes states.
//
// ODE supplies collision and the positions of joints; velocities and positions are advanced by us
// (advance()). Bodies and geoms are known by their index in SceneContent everywhere outside this file. ODE's
// initialisation, its message handlers and its random generator are global: worlds of one process share them
// and must not be used at the same time.
//
// ODE prints nothing and never ends the process: messages are counted, and what it calls errors (a broken
// argument, a failed assertion of its own) is thrown as std::runtime_error with ODE's text.
#pragma once

#include <ode/ode.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/world/contact_points.h"
#include "scenarios/scene.h"

namespace cleave {

struct BodyState {
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation{1, 0, 0, 0};  // quaternion w x y z
  std::array<double, 6> velocity{};               // linear m/s, angular rad/s, world
};

class OdeWorld {
 public:
  // Initialises ODE (once per process), builds the scene with gravity (0, 0, -gravity_m_per_s2), auto-disable
  // off, and reseeds ODE's random generator. gyroscopic: ODE's implicit gyroscopic torque on every body.
  // Throws std::invalid_argument for a scene with triangle meshes, whose contacts depend on earlier calls.
  OdeWorld(const SceneEntry& scene, const Settings& settings, std::uint64_t seed, double gravity_m_per_s2,
           bool gyroscopic = true);
  OdeWorld(const OdeWorld&) = delete;
  OdeWorld& operator=(const OdeWorld&) = delete;

  // The same scene built anew, with ODE's ERP and CFM set before there is any joint (ball and fixed joints
  // copy them when they are made), and with bodies and joints as they are now: what ODE itself can step
  // without this world noticing. Throws std::runtime_error for a scene that sets ERP or CFM by itself.
  std::unique_ptr<OdeWorld> rebuilt(double erp, double cfm) const;

  void before_step(int step) { scene_->before_step(step, content_); }

  // All contact points of the present positions (contact_points.h).
  std::vector<ContactPoint> collide(int contact_cap, int* cap_hits);

  // Sets the velocities (n, 6) and moves the bodies by symplectic Euler and the exponential map of the
  // quaternion:
  //     x += h v,   q = (cos(h |omega| / 2), sin(h |omega| / 2) omega / |omega|) q
  // Throws std::runtime_error naming the body when a velocity is not finite; nothing has moved then.
  void advance(std::span<const double> velocity, double h_s);

  BodyState state(int body) const;
  std::vector<double> positions_m() const;  // (n, 3) of all bodies
  // Number of the group that each body belongs to, by first appearance, -1 for none; empty where none is
  // named.
  std::vector<int> body_groups() const;
  void set_state(int body, const BodyState& state);  // normalises the orientation
  std::uint64_t state_hash() const;  // FNV-1a-64 over position, orientation, velocity of all bodies by index

  double last_body_z_m() const;       // NaN without bodies
  double potential_energy_j() const;  // sum of m g z
  double kinetic_energy_j() const;    // sum of 1/2 m v.v + 1/2 omega.I omega

  // Number of messages ODE gave since the last call ("LCP internal error, s <= 0" and the like); the first
  // one's text goes to first_text, if asked for and if there was one.
  int take_message_count(std::string* first_text = nullptr);

  const SceneContent& content() const { return content_; }
  dWorldID world() const { return world_.get(); }
  int body_count() const { return static_cast<int>(content_.bodies.size()); }
  int body_index(dBodyID body) const;  // -1 for none (static)

 private:
  // What the scene was built from.
  struct Recipe {
    SceneEntry scene;
    Settings settings;
    std::uint64_t seed;
  };
  struct ErpCfm {
    double erp, cfm;
  };
  OdeWorld(Recipe recipe, double gravity_m_per_s2, bool gyroscopic, std::optional<ErpCfm> preset);

  struct Destroy {
    void operator()(dWorldID world) const { dWorldDestroy(world); }
    void operator()(dSpaceID space) const { dSpaceDestroy(space); }
  };

  Recipe recipe_;
  // In this order: the space goes before the world, and the scene, which may own vertices of geometry, after
  // both.
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<dxWorld, Destroy> world_;
  std::unique_ptr<dxSpace, Destroy> space_;
  SceneContent content_;
  double gravity_m_per_s2_ = 0;
};

}  // namespace cleave
