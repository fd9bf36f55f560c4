// The change of Coulomb's shift that belongs to a step of the semi-smooth Newton method (cone_newton.h).
//
// The shift s = mu |w_t| changes along a step by
//
//     ds = mu u . dw_t,   u = w_t / |w_t|,
//
// with the dw_t of the same step, which is what makes the derivative unsymmetric. A contact that sticks is to
// come to w_t = 0, so that its change is -s, and one that opens has none that matters. For a given ds of
// those that slide the step is that of a cone, one back-substitution with the factor at hand, and dw_t is
// affine in ds. So one unknown a sliding contact remains, ds = r + A ds with A known by back-substitutions
// alone; coulomb_shift.h's acceleration is GMRES there.
#pragma once

#include <span>
#include <vector>

#include "solver/solve_state.h"
#include "solver/strategies/coulomb_shift.h"

namespace cleave {

class StepShift {
 public:
  // Of the step from slacks slack_before (m, m/s), with state.slack where the factored step begins; the
  // change is zero. slides: (cones) 1 where a contact does. accuracy: share of what the change is off at
  // first to which it is to be matched.
  void begin(SolveState& state, std::span<const double> slack_before, std::span<const char> slides,
             double accuracy);

  // Of the next back-substitution: state.f_r <- f_r - ds on the normals.
  void add_to_right_hand_side(SolveState& state) const;

  // After the back-substitution: whether the change that it leads to is near enough to the one that it was
  // for. Makes the next change.
  bool is_matched(SolveState& state);

 private:
  // mu u . dw_t of a contact as change + row . (dv of its two bodies) + compliance . dlambda_t.
  struct Contact {
    double row[12] = {};
    double change = 0;
    double compliance[2] = {};
  };
  static Contact linearize(const SolveState& state, const FrictionCone& cone,
                           std::span<const double> slack_before);

  CoulombShift shift_;
  double accuracy_ = 0;
  double first_apart_ = -1;  // m/s; negative before the first back-substitution
  std::vector<FrictionCone> sliding_;
  std::vector<Contact> contacts_;  // of each
  std::vector<double> wanted_;     // of each, m/s
};

}  // namespace cleave
