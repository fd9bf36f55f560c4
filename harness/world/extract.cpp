#include "harness/world/extract.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "harness/world/body_terms.h"
#include "harness/world/extract_row.h"
#include "harness/world/joint_rows.h"

namespace cleave {
namespace {

using Vector = std::array<double, 3>;

void require_in_range(const char* name, double value, bool zero_allowed) {
  if (std::isfinite(value) && (value > 0 || (zero_allowed && value == 0))) return;
  std::ostringstream message;
  message << name << " = " << value << ", allowed: finite and " << (zero_allowed ? ">= 0" : "> 0");
  throw std::invalid_argument(message.str());
}

void require_valid(const ExtractOptions& options) {
  require_in_range("h_s", options.h_s, false);
  require_in_range("erp", options.erp, true);
  require_in_range("cfm", options.cfm, true);
  require_in_range("mu", options.mu, true);
  require_in_range("friction_force_n", options.friction_force_n, true);
}

bool has_friction_rows(const ExtractOptions& options) {
  switch (options.friction) {
    case FrictionModel::none:
      return false;
    case FrictionModel::constant:
      return options.friction_force_n > 0;
    case FrictionModel::box:
    case FrictionModel::box_converged:
    case FrictionModel::cone:
    case FrictionModel::coulomb:
      return options.mu > 0;
  }
  return false;
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector lever(const OdeWorld& world, int body, const Vector& point) {
  const dReal* centre = dBodyGetPosition(world.content().bodies[body]);
  return {point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]};
}

// Velocity of body_a's point relative to body_b's along a direction.
std::array<double, 12> point_jacobian(const OdeWorld& world, const ContactPoint& contact,
                                      const Vector& direction) {
  std::array<double, 12> jacobian{};
  const Vector angular_a = cross(lever(world, contact.body_a, contact.position_m), direction);
  std::copy(direction.begin(), direction.end(), jacobian.begin());
  std::copy(angular_a.begin(), angular_a.end(), jacobian.begin() + 3);
  if (contact.body_b < 0) return jacobian;
  const Vector angular_b = cross(lever(world, contact.body_b, contact.position_m), direction);
  for (int k = 0; k < 3; ++k) {
    jacobian[6 + k] = -direction[k];
    jacobian[9 + k] = -angular_b[k];
  }
  return jacobian;
}

// ODE's push-out velocity: the surface layer may overlap freely, and the speed is capped by the world's
// setting.
double push_out_m_per_s(dWorldID world, double depth_m, const ExtractOptions& options) {
  const double depth = std::max(0.0, depth_m - dWorldGetContactSurfaceLayer(world));
  return std::min(options.erp / options.h_s * depth,
                  static_cast<double>(dWorldGetContactMaxCorrectingVel(world)));
}

std::array<Vector, 3> contact_frame(const Vector& normal) {
  const dVector3 n = {normal[0], normal[1], normal[2]};
  dVector3 t1, t2;
  dPlaneSpace(n, t1, t2);
  return {normal, Vector{t1[0], t1[1], t1[2]}, Vector{t2[0], t2[1], t2[2]}};
}

void append_contact(const OdeWorld& world, const ContactPoint& contact, int constraint,
                    const ExtractOptions& options, const std::array<double, 3>& warm_impulse,
                    StepProblem& problem) {
  assert(contact.body_a >= 0);
  const std::array<Vector, 3> frame = contact_frame(contact.normal);
  ExtractedRow row;
  row.body_a = contact.body_a;
  row.body_b = contact.body_b;
  row.compliance = options.cfm / options.h_s;
  row.constraint = constraint;
  row.point_m = contact.position_m;

  row.jacobian = point_jacobian(world, contact, frame[0]);
  row.kind = RowKind::normal;
  row.rhs_m_per_s = push_out_m_per_s(world.world(), contact.depth_m, options);
  row.lower = 0;
  row.warm_impulse = warm_impulse[0];
  const int normal_row = append_row(row, problem);
  if (!has_friction_rows(options)) return;

  const bool constant = options.friction == FrictionModel::constant;
  row.kind = RowKind::friction;
  row.rhs_m_per_s = 0;
  row.normal_row = normal_row;
  row.mu = constant ? 0 : options.mu;
  row.upper = constant ? options.h_s * options.friction_force_n : options.mu * std::max(0.0, warm_impulse[0]);
  row.lower = -row.upper;
  for (int k = 1; k < 3; ++k) {
    row.jacobian = point_jacobian(world, contact, frame[k]);
    row.warm_impulse = warm_impulse[k];
    append_row(row, problem);
  }
}

}  // namespace

StepProblem extract(const OdeWorld& world, std::span<const ContactPoint> contacts,
                    const ExtractOptions& options, const ContactMemory& memory) {
  require_valid(options);
  StepProblem problem;
  problem.h_s = options.h_s;
  reserve_rows(contacts.size() * (has_friction_rows(options) ? 3 : 1) + 6 * world.content().joints.size(),
               problem);
  append_body_terms(world, options.h_s, problem);
  append_joint_rows(world, options.h_s, options.erp, options.cfm, memory, problem);
  const int joints = static_cast<int>(world.content().joints.size());
  const std::vector<int> continued = memory.match(world, contacts);
  for (int k = 0; k < static_cast<int>(contacts.size()); ++k) {
    std::array<double, 3> warm_impulse{};
    if (continued[k] >= 0) warm_impulse = memory.contact_impulse(continued[k]);
    append_contact(world, contacts[k], joints + k, options, warm_impulse, problem);
  }
  return problem;
}

}  // namespace cleave
