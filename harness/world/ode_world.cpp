#include "harness/world/ode_world.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "harness/base/hash.h"
#include "harness/world/joint_axes.h"
#include "harness/world/ode_index.h"
#include "harness/world/ode_library.h"

namespace cleave {
namespace {

// exp(h omega) q, both as quaternions; sin(x)/x by its series where the quotient would lose digits.
void rotate(dQuaternion q, const double* omega, double h_s) {
  const double half = std::sqrt(omega[0] * omega[0] + omega[1] * omega[1] + omega[2] * omega[2]) * h_s / 2;
  const double scale = h_s / 2 * (half < 1e-4 ? 1 - half * half / 6 : std::sin(half) / half);
  const dQuaternion turn{std::cos(half), scale * omega[0], scale * omega[1], scale * omega[2]};
  const dQuaternion before{q[0], q[1], q[2], q[3]};
  dQMultiply0(q, turn, before);
}

// What acts on a body, which scenes may change while they run.
void copy_forces(dBodyID from, dBodyID to) {
  const dReal *force = dBodyGetForce(from), *torque = dBodyGetTorque(from);
  dBodySetForce(to, force[0], force[1], force[2]);
  dBodySetTorque(to, torque[0], torque[1], torque[2]);
  dBodySetGravityMode(to, dBodyGetGravityMode(from));
  dBodySetGyroscopicMode(to, dBodyGetGyroscopicMode(from));
}

}  // namespace

OdeWorld::OdeWorld(const SceneEntry& scene, const Settings& settings, std::uint64_t seed,
                   double gravity_m_per_s2, bool gyroscopic)
    : OdeWorld({scene, settings, seed}, gravity_m_per_s2, gyroscopic, std::nullopt) {}

OdeWorld::OdeWorld(Recipe recipe, double gravity_m_per_s2, bool gyroscopic, std::optional<ErpCfm> preset)
    : recipe_(std::move(recipe)), scene_(recipe_.scene.make()), gravity_m_per_s2_(gravity_m_per_s2) {
  const std::uint64_t seed = recipe_.seed;
  initialise_ode();
  dRandSetSeed(static_cast<std::uint32_t>(seed ^ (seed >> 32)));
  world_.reset(dWorldCreate());
  space_.reset(dSimpleSpaceCreate(nullptr));  // it holds the geoms; near pairs are found by ourselves
  dWorldSetGravity(world_.get(), 0, 0, -gravity_m_per_s2);
  dWorldSetAutoDisableFlag(world_.get(), 0);
  if (preset) {
    dWorldSetERP(world_.get(), preset->erp);
    dWorldSetCFM(world_.get(), preset->cfm);
  }
  content_ = scene_->build(world_.get(), space_.get(), recipe_.settings, seed);
  assert(dSpaceGetNumGeoms(space_.get()) == static_cast<int>(content_.geoms.size()));
  for (int i = 0; i < body_count(); ++i) {
    dBodySetData(content_.bodies[i], to_data(i));
    dBodySetGyroscopicMode(content_.bodies[i], gyroscopic);
  }
  for (int i = 0; i < static_cast<int>(content_.geoms.size()); ++i) {
    if (dGeomGetClass(content_.geoms[i]) == dTriMeshClass)
      throw std::invalid_argument(std::string("scene '") + recipe_.scene.name +
                                  "': triangle meshes are not supported");
    dGeomSetData(content_.geoms[i], to_data(i));
  }
}

std::unique_ptr<OdeWorld> OdeWorld::rebuilt(double erp, double cfm) const {
  std::unique_ptr<OdeWorld> copy(new OdeWorld(recipe_, gravity_m_per_s2_, true, ErpCfm{erp, cfm}));
  if (dWorldGetERP(copy->world()) != erp || dWorldGetCFM(copy->world()) != cfm)
    throw std::runtime_error(std::string("scene '") + recipe_.scene.name +
                             "' sets ERP or CFM by itself; ODE's own solvers take those of the step");
  for (int i = 0; i < body_count(); ++i) {
    copy->set_state(i, state(i));
    copy_forces(content_.bodies[i], copy->content_.bodies[i]);
  }
  for (std::size_t j = 0; j < content_.joints.size(); ++j) {
    (dJointIsEnabled(content_.joints[j]) ? dJointEnable : dJointDisable)(copy->content_.joints[j]);
    copy_axis(content_.joints[j], copy->content_.joints[j]);
  }
  return copy;
}

std::vector<ContactPoint> OdeWorld::collide(int contact_cap, int* cap_hits) {
  return find_contact_points(content_.geoms, contact_cap, cap_hits);
}

void OdeWorld::advance(std::span<const double> velocity, double h_s) {
  assert(velocity.size() == 6 * content_.bodies.size());
  for (std::size_t k = 0; k < velocity.size(); ++k)
    if (!std::isfinite(velocity[k]))
      throw std::runtime_error("velocity of body " + std::to_string(k / 6) + " is not finite");
  for (int i = 0; i < body_count(); ++i) {
    const double* v = velocity.data() + 6 * i;
    const dBodyID body = content_.bodies[i];
    const dReal* x = dBodyGetPosition(body);
    const dReal* present = dBodyGetQuaternion(body);
    dQuaternion q{present[0], present[1], present[2], present[3]};
    rotate(q, v + 3, h_s);
    dBodySetPosition(body, x[0] + h_s * v[0], x[1] + h_s * v[1], x[2] + h_s * v[2]);
    dBodySetQuaternion(body, q);
    dBodySetLinearVel(body, v[0], v[1], v[2]);
    dBodySetAngularVel(body, v[3], v[4], v[5]);
  }
}

BodyState OdeWorld::state(int body) const {
  const dBodyID b = content_.bodies[body];
  const dReal *x = dBodyGetPosition(b), *q = dBodyGetQuaternion(b);
  const dReal *v = dBodyGetLinearVel(b), *w = dBodyGetAngularVel(b);
  return {{x[0], x[1], x[2]}, {q[0], q[1], q[2], q[3]}, {v[0], v[1], v[2], w[0], w[1], w[2]}};
}

std::vector<double> OdeWorld::positions_m() const {
  std::vector<double> positions_m;
  for (int body = 0; body < body_count(); ++body) {
    const std::array<double, 3> position_m = state(body).position_m;
    positions_m.insert(positions_m.end(), position_m.begin(), position_m.end());
  }
  return positions_m;
}

std::vector<int> OdeWorld::body_groups() const {
  std::map<std::string, int> number_of_name;
  std::vector<int> groups;
  for (const std::string& name : content_.body_group)
    groups.push_back(
        name.empty() ? -1
                     : number_of_name.emplace(name, static_cast<int>(number_of_name.size())).first->second);
  return number_of_name.empty() ? std::vector<int>() : groups;
}

void OdeWorld::set_state(int body, const BodyState& state) {
  const dBodyID b = content_.bodies[body];
  const auto& v = state.velocity;
  dBodySetPosition(b, state.position_m[0], state.position_m[1], state.position_m[2]);
  dBodySetQuaternion(b, state.orientation.data());
  dBodySetLinearVel(b, v[0], v[1], v[2]);
  dBodySetAngularVel(b, v[3], v[4], v[5]);
}

std::uint64_t OdeWorld::state_hash() const {
  Fnv1a64 hash;
  for (int i = 0; i < body_count(); ++i) {
    const BodyState s = state(i);
    hash.add(std::span<const double>(s.position_m));
    hash.add(std::span<const double>(s.orientation));
    hash.add(std::span<const double>(s.velocity));
  }
  return hash.value();
}

double OdeWorld::last_body_z_m() const {
  return content_.bodies.empty() ? std::numeric_limits<double>::quiet_NaN()
                                 : dBodyGetPosition(content_.bodies.back())[2];
}

double OdeWorld::potential_energy_j() const {
  double sum = 0;
  for (const dBodyID body : content_.bodies) {
    dMass mass;
    dBodyGetMass(body, &mass);
    sum += mass.mass * gravity_m_per_s2_ * dBodyGetPosition(body)[2];
  }
  return sum;
}

double OdeWorld::kinetic_energy_j() const {
  double sum = 0;
  for (const dBodyID body : content_.bodies) {
    dMass mass;
    dBodyGetMass(body, &mass);
    const dReal *v = dBodyGetLinearVel(body), *w = dBodyGetAngularVel(body);
    // The inertia is constant in the body's frame, so omega goes there.
    dVector3 local_w, spin;
    dMultiply1_331(local_w, dBodyGetRotation(body), w);
    dMultiply0_331(spin, mass.I, local_w);
    sum += 0.5 * (mass.mass * dCalcVectorDot3(v, v) + dCalcVectorDot3(local_w, spin));
  }
  return sum;
}

int OdeWorld::take_message_count(std::string* first_text) { return take_ode_messages(first_text); }

int OdeWorld::body_index(dBodyID body) const { return index_of(body); }

}  // namespace cleave
