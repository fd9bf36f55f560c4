#include "harness/world/joint_rows.h"

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/larger_or_nan.h"
#include "harness/world/body_terms.h"
#include "harness/world/extract_row.h"
#include "harness/world/joint_axes.h"
#include "harness/world/ode_joint.h"

namespace cleave {
namespace {

// A joint that exists only on its bodies' lists would be dropped without a word. Contact joints live for one
// step and are built from the contact points that are extracted.
void require_joints_listed(const OdeWorld& world) {
  std::vector<dJointID> listed = world.content().joints;
  std::sort(listed.begin(), listed.end());
  for (int i = 0; i < world.body_count(); ++i) {
    const dBodyID body = world.content().bodies[i];
    for (int k = 0; k < dBodyGetNumJoints(body); ++k) {
      const dJointID joint = dBodyGetJoint(body, k);
      if (dJointGetType(joint) == dJointTypeContact ||
          std::binary_search(listed.begin(), listed.end(), joint))
        continue;
      throw std::runtime_error("body " + std::to_string(i) + ": its " +
                               joint_type_name(dJointGetType(joint)) +
                               " joint is not among the scene's joints");
    }
  }
}

int attached_body(const OdeWorld& world, dJointID joint, int side, int index) {
  const dBodyID body = dJointGetBody(joint, side);
  const int own_index = world.body_index(body);
  if (body && own_index < 0)
    throw std::runtime_error("joint " + std::to_string(index) +
                             ": a body of it is not among the scene's bodies");
  return own_index;
}

// A row that comes and goes, that of a stop, may come back with other bounds than it was left with.
double warm_impulse(std::span<const double> remembered, int r, const ExtractedRow& row) {
  return r < std::ssize(remembered) ? std::clamp(remembered[r], row.lower, row.upper) : 0;
}

// A force along a row as if from outside.
void push_along(const ExtractedRow& row, double force, StepProblem& problem) {
  std::array<double, 12> on_bodies = row.jacobian;
  for (double& entry : on_bodies) entry *= force;
  add_force(row.body_a, std::span(on_bodies).first<6>(), problem);
  if (row.body_b >= 0) add_force(row.body_b, std::span(on_bodies).last<6>(), problem);
}

void append_joint(const OdeWorld& world, int index, double h_s, double erp, double cfm,
                  const ContactMemory& memory, StepProblem& problem) {
  const dJointID joint = world.content().joints[index];
  const OdeJointRows rows = ode_joint_rows(world.world(), joint, index, h_s, erp, cfm);
  ExtractedRow row;
  row.body_a = attached_body(world, joint, 0, index);
  row.body_b = attached_body(world, joint, 1, index);
  // ODE keeps the dynamic body of such a joint first and fills the first Jacobian block for it.
  if (row.body_a < 0) std::swap(row.body_a, row.body_b);
  if (rows.count == 0) return;
  row.constraint = index;
  std::copy(rows.point_m, rows.point_m + 3, row.point_m.begin());

  const std::span<const double> warm = memory.joint_impulse(index);
  for (int r = 0; r < rows.count; ++r) {
    std::copy(rows.jacobian[r], rows.jacobian[r] + 12, row.jacobian.begin());
    row.rhs_m_per_s = rows.rhs_cfm[r][0];
    row.compliance = rows.rhs_cfm[r][1] / h_s;
    row.lower = h_s * rows.lo_hi[r][0];
    row.upper = h_s * rows.lo_hi[r][1];
    row.warm_impulse = warm_impulse(warm, r, row);
    append_row(row, problem);
  }
  if (rows.motor_force != 0) push_along(row, rows.motor_force, problem);
}

}  // namespace

double joint_drift_m(const OdeWorld& world) {
  double widest = 0;
  const int joints = static_cast<int>(world.content().joints.size());
  for (int j = 0; j < joints; ++j) {
    widest = larger_or_nan(widest, ode_joint_gap_m(world.content().joints[j], j));
  }
  return widest;
}

void append_joint_rows(const OdeWorld& world, double h_s, double erp, double cfm, const ContactMemory& memory,
                       StepProblem& problem) {
  require_joints_listed(world);
  const int joints = static_cast<int>(world.content().joints.size());
  for (int j = 0; j < joints; ++j) append_joint(world, j, h_s, erp, cfm, memory, problem);
}

}  // namespace cleave
