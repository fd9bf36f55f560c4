#include "harness/world/joint_rows.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "harness/world/extract_row.h"

// ODE's joint classes, as far as we call them: libode exports these functions but no header declares them.
// The names that the linker looks up carry the argument types, so a library with another signature fails to
// link.
//   inverse_h: 1/s    J1, J2: rows at distance row_stride    rhs_cfm, lo_hi: pairs at distance pair_stride
struct dxJointBall {
  void getInfo2(double inverse_h, double erp, int row_stride, double* J1, double* J2, int pair_stride,
                double* rhs_cfm, double* lo_hi, int* findex);
};
struct dxJointHinge {
  void getInfo2(double inverse_h, double erp, int row_stride, double* J1, double* J2, int pair_stride,
                double* rhs_cfm, double* lo_hi, int* findex);
};
struct dxJointSlider {
  void getInfo2(double inverse_h, double erp, int row_stride, double* J1, double* J2, int pair_stride,
                double* rhs_cfm, double* lo_hi, int* findex);
};
struct dxJointFixed {
  void getInfo2(double inverse_h, double erp, int row_stride, double* J1, double* J2, int pair_stride,
                double* rhs_cfm, double* lo_hi, int* findex);
};

namespace cleave {
namespace {

constexpr int kMostRows = 6;

struct OdeRows {
  double jacobian[kMostRows][12] = {};  // ODE adds to zeros
  double rhs_cfm[kMostRows][2] = {};
  double lo_hi[kMostRows][2] = {};
  int findex[kMostRows] = {};
};

// A joint kind that is extracted. limit_param is null for a joint without limits and motors, own_param and
// set_own_param for one without an erp and a cfm of its own.
struct JointKind {
  dJointType type;
  const char* name;
  int rows;
  void (*fill)(dJointID joint, double inverse_h, double erp, OdeRows& rows);
  void (*anchor)(dJointID joint, dVector3 point);
  dReal (*limit_param)(dJointID joint, int parameter);
  dReal (*own_param)(dJointID joint, int parameter);
  void (*set_own_param)(dJointID joint, int parameter, dReal value);
};

template <typename OdeJoint>
void fill_rows(dJointID joint, double inverse_h, double erp, OdeRows& rows) {
  reinterpret_cast<OdeJoint*>(joint)->getInfo2(inverse_h, erp, 12, rows.jacobian[0], rows.jacobian[0] + 6, 2,
                                               rows.rhs_cfm[0], rows.lo_hi[0], rows.findex);
}

// Slider and fixed joints have no anchor; their force acts between the bodies as wholes.
void first_body_position(dJointID joint, dVector3 point) {
  const dBodyID first = dJointGetBody(joint, 0);
  const dReal* position = dBodyGetPosition(first ? first : dJointGetBody(joint, 1));
  std::copy(position, position + 3, point);
}

const JointKind kJointKinds[] = {
    {dJointTypeBall, "ball", 3, fill_rows<dxJointBall>, dJointGetBallAnchor, nullptr, dJointGetBallParam,
     dJointSetBallParam},
    {dJointTypeHinge, "hinge", 5, fill_rows<dxJointHinge>, dJointGetHingeAnchor, dJointGetHingeParam, nullptr,
     nullptr},
    {dJointTypeSlider, "slider", 5, fill_rows<dxJointSlider>, first_body_position, dJointGetSliderParam,
     nullptr, nullptr},
    {dJointTypeFixed, "fixed", 6, fill_rows<dxJointFixed>, first_body_position, nullptr, dJointGetFixedParam,
     dJointSetFixedParam},
};

// By dJointType.
constexpr const char* kTypeNames[] = {"unknown",
                                      "ball",
                                      "hinge",
                                      "slider",
                                      "contact",
                                      "universal",
                                      "hinge2",
                                      "fixed",
                                      "null",
                                      "angular motor",
                                      "linear motor",
                                      "plane2d",
                                      "prismatic-rotoide",
                                      "prismatic-universal",
                                      "piston",
                                      "double ball",
                                      "double hinge",
                                      "transmission"};
static_assert(std::size(kTypeNames) == dJointTypeTransmission + 1);

const JointKind& extracted_kind(dJointID joint, int index) {
  const dJointType type = dJointGetType(joint);
  const auto* kind = std::find_if(std::begin(kJointKinds), std::end(kJointKinds),
                                  [type](const JointKind& k) { return k.type == type; });
  if (kind == std::end(kJointKinds))
    throw std::runtime_error("joint " + std::to_string(index) + ": type " + kTypeNames[type] +
                             " is not extracted from ODE (ball, hinge, slider and fixed are)");
  return *kind;
}

void require_no_limit_or_motor(dJointID joint, const JointKind& kind, int index) {
  if (!kind.limit_param) return;
  const char* feature = nullptr;
  if (std::isfinite(kind.limit_param(joint, dParamLoStop)) ||
      std::isfinite(kind.limit_param(joint, dParamHiStop)))
    feature = "limit";
  if (kind.limit_param(joint, dParamFMax) != 0) feature = "motor";
  if (feature)
    throw std::runtime_error("joint " + std::to_string(index) + ": a " + feature + " on a " + kind.name +
                             " joint is not extracted from ODE");
}

// Gives an own parameter of a joint another value while ODE fills the rows, and puts it back.
class StepValue {
 public:
  StepValue(dJointID joint, const JointKind& kind, int parameter, double step_value)
      : joint_(joint), kind_(kind), parameter_(parameter) {
    if (!kind.own_param) return;
    own_value_ = kind.own_param(joint, parameter);
    kind.set_own_param(joint, parameter, step_value);
  }
  ~StepValue() {
    if (kind_.own_param) kind_.set_own_param(joint_, parameter_, own_value_);
  }
  StepValue(const StepValue&) = delete;
  StepValue& operator=(const StepValue&) = delete;

 private:
  dJointID joint_;
  const JointKind& kind_;
  int parameter_;
  double own_value_ = 0;
};

// A joint's own parameter, or the step's where it was never set.
double own_or_step(dJointID joint, const JointKind& kind, int parameter, double world_value,
                   double step_value) {
  if (!kind.own_param) return step_value;
  const double own_value = kind.own_param(joint, parameter);
  return own_value == world_value ? step_value : own_value;
}

OdeRows ode_rows(dWorldID world, dJointID joint, const JointKind& kind, double h_s, double erp, double cfm) {
  const StepValue step_erp(joint, kind, dParamERP,
                           own_or_step(joint, kind, dParamERP, dWorldGetERP(world), erp));
  const StepValue step_cfm(joint, kind, dParamCFM,
                           own_or_step(joint, kind, dParamCFM, dWorldGetCFM(world), cfm));
  OdeRows rows;
  for (auto& pair : rows.rhs_cfm) pair[1] = cfm;  // as dWorldStep presets it
  kind.fill(joint, 1 / h_s, erp, rows);
  return rows;
}

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
      throw std::runtime_error("body " + std::to_string(i) + ": its " + kTypeNames[dJointGetType(joint)] +
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

void append_joint(const OdeWorld& world, int index, double h_s, double erp, double cfm,
                  const ContactMemory& memory, StepProblem& problem) {
  const dJointID joint = world.content().joints[index];
  const JointKind& kind = extracted_kind(joint, index);
  require_no_limit_or_motor(joint, kind, index);
  ExtractedRow row;
  row.body_a = attached_body(world, joint, 0, index);
  row.body_b = attached_body(world, joint, 1, index);
  // ODE keeps the dynamic body of such a joint first and fills the first Jacobian block for it.
  if (row.body_a < 0) std::swap(row.body_a, row.body_b);
  if (row.body_a < 0 || !dJointIsEnabled(joint)) return;
  row.constraint = index;
  dVector3 anchor;
  kind.anchor(joint, anchor);
  row.point_m = {anchor[0], anchor[1], anchor[2]};

  const OdeRows rows = ode_rows(world.world(), joint, kind, h_s, erp, cfm);
  const std::span<const double> warm = memory.joint_impulse(index);
  assert(warm.empty() || static_cast<int>(warm.size()) == kind.rows);
  for (int r = 0; r < kind.rows; ++r) {
    std::copy(rows.jacobian[r], rows.jacobian[r] + 12, row.jacobian.begin());
    row.rhs_m_per_s = rows.rhs_cfm[r][0];
    row.compliance = rows.rhs_cfm[r][1] / h_s;
    row.warm_impulse = warm.empty() ? 0 : warm[r];
    append_row(row, problem);
  }
}

// With an erp of 1 and a step of 1 s ODE's right-hand sides are the position errors.
double gap_m(dJointID joint, const JointKind& kind) {
  const StepValue whole_error(joint, kind, dParamERP, 1);
  OdeRows rows;
  kind.fill(joint, 1, 1, rows);
  double sum = 0;
  for (int r = 0; r < kind.rows; ++r) {
    const double* linear = rows.jacobian[r];
    const bool holds_points = linear[0] != 0 || linear[1] != 0 || linear[2] != 0;
    if (holds_points) sum += rows.rhs_cfm[r][0] * rows.rhs_cfm[r][0];
  }
  return std::sqrt(sum);
}

}  // namespace

double joint_drift_m(const OdeWorld& world) {
  double widest = 0;
  const int joints = static_cast<int>(world.content().joints.size());
  for (int j = 0; j < joints; ++j) {
    const dJointID joint = world.content().joints[j];
    if (!dJointIsEnabled(joint)) continue;
    const double gap = gap_m(joint, extracted_kind(joint, j));
    if (!(gap <= widest)) widest = gap;
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
