// ODE's permanent joints as ODE itself sees them: their rows come from the functions that dWorldStep calls,
// because ODE's public interface does not give a joint's rest pose (the relative rotation a fixed joint or a
// slider holds).
//
// Ball (3 rows), hinge (5), slider (5) and fixed (6). A hinge or slider that is driven by a motor or at one
// of its stops has a sixth row, of its axis a, with J v the speed along or about it:
//     motor:         b = wanted speed,                          -F_max <= force <= F_max
//     at a stop:     b = -(stop erp / h) (position - stop), or the speed it bounces back with,
//                    0 <= force at the low stop, force <= 0 at the high one, any where the two are one
//     both at once:  the row of the stop; the motor pushes the bodies with F_max from outside (times the
//                    fudge factor where it drives off the stop)
//
// Softness: a joint has parameters of its own, which ODE copies from the world's ERP and CFM when it is
// created. One that still equals dWorldGetERP (dWorldGetCFM) counts as not set and takes the step's value;
// another one is kept. A world's ERP and CFM must therefore not be changed after its joints exist. Ball: all
// rows; fixed: the three position rows only, as in ODE; hinge and slider: cfm of the motor, erp and cfm of
// the stops.
#pragma once

#include <ode/ode.h>

namespace cleave {

struct OdeJointRows {
  static constexpr int kMost = 6;
  int count = 0;                    // rows that there are
  int permanent = 0;                // the first of them, which hold whatever the state
  double jacobian[kMost][12] = {};  // of the first body, then of the second
  double rhs_cfm[kMost][2] = {};    // b in m/s or rad/s, cfm
  double lo_hi[kMost][2] = {};      // bounds of the force, N or N m
  int findex[kMost] = {};
  // Where the force acts: the anchor; the first body's centre for a slider or fixed joint, which has none.
  dVector3 point_m = {};
  // With which a motor at a stop pushes along or about the axis, in the sense of the sixth row: N, N m.
  double motor_force = 0;
};

// erp, cfm: of the step. No rows where the joint is disabled or has no body. Leaves the joint as it was.
// Throws std::runtime_error naming the joint by its index when its type is another one.
OdeJointRows ode_joint_rows(dWorldID world, dJointID joint, int index, double h_s, double erp, double cfm);

// How far the points are apart that an enabled joint holds together: the norm of ODE's position error over
// those of its permanent rows that are not about directions, m. Throws as above.
double ode_joint_gap_m(dJointID joint, int index);

}  // namespace cleave
