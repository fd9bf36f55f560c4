#include "harness/world/ode_joint.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

#include "harness/world/joint_axes.h"

// ODE's joint classes, as far as we call them: libode exports these functions but no header declares them.
// The names that the linker looks up carry the argument types, so a library with another signature fails to
// link.
//   getInfo1: looks whether the joint is at a stop, which getInfo2 goes by; m: rows
//   inverse_h: 1/s    J1, J2: rows at distance row_stride    rhs_cfm, lo_hi: pairs at distance pair_stride
struct dxJoint {
  struct Info1 {
    std::uint8_t m, nub;
  };
};
#define CLEAVE_ODE_JOINT(Class)                                                                          \
  struct Class {                                                                                         \
    void getInfo1(dxJoint::Info1* info);                                                                 \
    void getInfo2(double inverse_h, double erp, int row_stride, double* J1, double* J2, int pair_stride, \
                  double* rhs_cfm, double* lo_hi, int* findex);                                          \
  }
CLEAVE_ODE_JOINT(dxJointBall);
CLEAVE_ODE_JOINT(dxJointHinge);
CLEAVE_ODE_JOINT(dxJointSlider);
CLEAVE_ODE_JOINT(dxJointFixed);
#undef CLEAVE_ODE_JOINT

namespace cleave {
namespace {

// An erp or cfm that a joint has of its own.
struct OwnParameter {
  int parameter;
  bool is_erp;
};
constexpr OwnParameter kOfJoint[] = {{dParamERP, true}, {dParamCFM, false}};
constexpr OwnParameter kOfAxis[] = {{dParamCFM, false}, {dParamStopERP, true}, {dParamStopCFM, false}};

struct JointKind {
  dJointType type;
  int permanent_rows;
  int (*count)(dJointID joint);  // rows in the present state; must come before fill
  void (*fill)(dJointID joint, double inverse_h, double erp, OdeJointRows& rows);
  void (*anchor)(dJointID joint, dVector3 point);
  dReal (*get)(dJointID joint, int parameter);
  void (*set)(dJointID joint, int parameter, dReal value);
  std::span<const OwnParameter> own;
  bool has_axis() const { return own.data() == kOfAxis; }
};

template <typename OdeJoint>
int count_rows(dJointID joint) {
  dxJoint::Info1 info{};
  reinterpret_cast<OdeJoint*>(joint)->getInfo1(&info);
  return info.m;
}

template <typename OdeJoint>
void fill_rows(dJointID joint, double inverse_h, double erp, OdeJointRows& rows) {
  reinterpret_cast<OdeJoint*>(joint)->getInfo2(inverse_h, erp, 12, rows.jacobian[0], rows.jacobian[0] + 6, 2,
                                               rows.rhs_cfm[0], rows.lo_hi[0], rows.findex);
}

void first_body_position(dJointID joint, dVector3 point) {
  const dBodyID first = dJointGetBody(joint, 0);
  const dReal* position = dBodyGetPosition(first ? first : dJointGetBody(joint, 1));
  std::copy(position, position + 3, point);
}

const JointKind kJointKinds[] = {
    {dJointTypeBall, 3, count_rows<dxJointBall>, fill_rows<dxJointBall>, dJointGetBallAnchor,
     dJointGetBallParam, dJointSetBallParam, kOfJoint},
    {dJointTypeHinge, 5, count_rows<dxJointHinge>, fill_rows<dxJointHinge>, dJointGetHingeAnchor,
     dJointGetHingeParam, dJointSetHingeParam, kOfAxis},
    {dJointTypeSlider, 5, count_rows<dxJointSlider>, fill_rows<dxJointSlider>, first_body_position,
     dJointGetSliderParam, dJointSetSliderParam, kOfAxis},
    {dJointTypeFixed, 6, count_rows<dxJointFixed>, fill_rows<dxJointFixed>, first_body_position,
     dJointGetFixedParam, dJointSetFixedParam, kOfJoint},
};

const JointKind& extracted_kind(dJointID joint, int index) {
  const dJointType type = dJointGetType(joint);
  const auto* kind = std::ranges::find(kJointKinds, type, &JointKind::type);
  if (kind == std::end(kJointKinds))
    throw std::runtime_error("joint " + std::to_string(index) + ": type " + joint_type_name(type) +
                             " is not extracted from ODE (ball, hinge, slider and fixed are)");
  return *kind;
}

bool has_rows(dJointID joint) {
  return dJointIsEnabled(joint) && (dJointGetBody(joint, 0) || dJointGetBody(joint, 1));
}

// Gives a joint other values of its parameters while ODE fills the rows, and puts them back.
class Lent {
 public:
  Lent(dJointID joint, const JointKind& kind) : joint_(joint), kind_(kind) {}
  ~Lent() {
    while (count_-- > 0) kind_.set(joint_, parameter_[count_], before_[count_]);
  }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;

  void set(int parameter, double value) {
    parameter_[count_] = parameter;
    before_[count_++] = kind_.get(joint_, parameter);
    kind_.set(joint_, parameter, value);
  }

 private:
  static constexpr int kMost = std::size(kOfAxis) + 1;
  dJointID joint_;
  const JointKind& kind_;
  std::array<int, kMost> parameter_{};
  std::array<double, kMost> before_{};
  int count_ = 0;
};

// world: where a parameter is not what the world has, it was set and stays; null: none stays.
void lend_softness(dWorldID world, dJointID joint, const JointKind& kind, double erp, double cfm,
                   Lent& lent) {
  for (const auto [parameter, is_erp] : kind.own) {
    const bool is_set =
        world && kind.get(joint, parameter) != (is_erp ? dWorldGetERP(world) : dWorldGetCFM(world));
    if (!is_set) lent.set(parameter, is_erp ? erp : cfm);
  }
}

// As in ODE: no speed drives into the stop, and where both stops are one no motor does anything.
double motor_force_at_stop(dJointID joint, const JointKind& kind, double most, const double* lo_hi) {
  const bool at_low = lo_hi[0] == 0, at_high = lo_hi[1] == 0;
  if (!at_low && !at_high) return 0;
  const double speed = kind.get(joint, dParamVel);
  const bool drives_off = at_low ? speed > 0 : speed < 0;
  if (drives_off) most *= kind.get(joint, dParamFudgeFactor);
  return speed > 0 || (speed == 0 && at_high) ? most : -most;
}

// At a stop ODE is asked without the motor: it would add the motor's force to the bodies here and now.
OdeJointRows filled_rows(dWorldID world, dJointID joint, const JointKind& kind, double h_s, double erp,
                         double cfm) {
  OdeJointRows rows;
  rows.permanent = kind.permanent_rows;
  // As dWorldStep presets them.
  for (auto& pair : rows.rhs_cfm) pair[1] = cfm;
  for (auto& pair : rows.lo_hi) pair[0] = -(pair[1] = std::numeric_limits<double>::infinity());
  Lent lent(joint, kind);
  lend_softness(world, joint, kind, erp, cfm, lent);
  const double most = kind.has_axis() ? kind.get(joint, dParamFMax) : 0;
  if (most > 0) lent.set(dParamFMax, 0);
  rows.count = kind.count(joint);
  const bool at_stop = rows.count > rows.permanent;
  if (most > 0 && !at_stop) {
    kind.set(joint, dParamFMax, most);
    rows.count = kind.count(joint);
  }
  kind.fill(joint, 1 / h_s, erp, rows);
  kind.anchor(joint, rows.point_m);
  if (most > 0 && at_stop)
    rows.motor_force = motor_force_at_stop(joint, kind, most, rows.lo_hi[rows.permanent]);
  return rows;
}

}  // namespace

OdeJointRows ode_joint_rows(dWorldID world, dJointID joint, int index, double h_s, double erp, double cfm) {
  const JointKind& kind = extracted_kind(joint, index);
  return has_rows(joint) ? filled_rows(world, joint, kind, h_s, erp, cfm) : OdeJointRows();
}

// With an erp of 1 and a step of 1 s ODE's right-hand sides are the position errors.
double ode_joint_gap_m(dJointID joint, int index) {
  const JointKind& kind = extracted_kind(joint, index);
  if (!has_rows(joint)) return 0;
  const OdeJointRows rows = filled_rows(nullptr, joint, kind, 1, 1, 0);
  double sum = 0;
  for (int r = 0; r < rows.permanent; ++r) {
    const double* linear = rows.jacobian[r];
    const bool holds_points = linear[0] != 0 || linear[1] != 0 || linear[2] != 0;
    if (holds_points) sum += rows.rhs_cfm[r][0] * rows.rhs_cfm[r][0];
  }
  return std::sqrt(sum);
}

}  // namespace cleave
