// The barrier of friction cones: for contacts with a cone (cone.h) what interval_barrier.h is for rows with
// bounds.
//
// With S = diag(mu, 1, 1) the slack s = S lambda and the multiplier z, w = S z, are points of the
// second-order cone Q = { x: |x_t| <= x_n }, and with x o y = (x . y, x_n y_t + y_n x_t) the conditions are
//
//     J v + C lambda - b - S z = 0,    s = S lambda,    s o z = mu e -> 0,   e = (1, 0, 0).
//
// The Nesterov-Todd scaling W makes both one point, l = W z = W^-T s. A contact keeps W, its inverse and l,
// and s and z only as what follows from them: near the surface of Q, s_n - |s_t| has no digits left in s.
// Scaled, a direction is
//
//     ds~ = W^-T (S dlambda + gap),  gap = S lambda - s,     dz~ = q - ds~,   l o q = c,
//
// where c is the change of the product that is aimed at; it leaves the kernel's system with
//
//     D^-1 = C + X X^T,  X = S W^-1,     f_r = -w + X (l + q - W^-T gap).
//
// After a step a, l + a ds~ and l + a dz~ are well inside Q, and with V their own scaling W <- V W, l <- V (l
// + a dz~). A contact counts as one product, s . z = l . l. Sources: Nesterov and Todd, "Self-scaled barriers
// and interior-point methods for convex programming", Math. Oper. Res. 22, 1997; Vandenberghe, "The CVXOPT
// linear and quadratic cone program solvers", 2010, section 4.3 (the update).
//
// With one tangent the third entry of every vector stays zero. Contacts are taken four at a time
// (cone_lanes.h); where fewer are left in a range of rows, the other lanes hold l = e, W = 1 and zeros, which
// add nothing.
#pragma once

#include <span>
#include <vector>

#include "solver/cone_lanes.h"
#include "solver/solve_state.h"
#include "solver/strategies/interior_constants.h"
#include "solver/strategies/interval_barrier.h"

namespace cleave {

class ConeBarrier {
 public:
  // Slacks and multipliers inside Q; speed (m): what d s and z of a contact are at least, m/s, on its normal
  // row.
  void start(SolveState& state, std::span<const double> speed);

  // inverse_weight (m): the compliance that is factored in, 1 / D along state.cone_blocks() out. Fixes W and
  // gap for the directions that follow.
  void weigh(SolveState& state, std::span<double> inverse_weight);

  // As IntervalBarrier's.
  void aim(SolveState& state, double product, bool second_order);
  void add_to_right_hand_side(SolveState& state) const;
  BarrierCourse follow(SolveState& state);
  // (cones) mu |w_t| after a full step along the direction, m/s; 0 where the law is not Coulomb's.
  void predict_shift(SolveState& state, std::span<double> shift) const;
  void correct(SolveState& state, double trial, double low, double high);
  void restore_direction() { now_.swap(before_); }
  // The largest entry of f_r - J dv - D^-1 dlambda on the rows of cones; row_velocity (m): J dv.
  double rounding(SolveState& state, std::span<const double> row_velocity);
  void advance(SolveState& state, double step);  // slacks and multipliers; impulses are IntervalBarrier's

  // One iterate, to come back to: it stays where it is, and the next one goes where the last one kept was.
  void keep() { is_kept_ = true; }
  void restore();
  std::size_t product_count() const { return count_; }

 private:
  struct Point {
    LaneMatrix w, w_inverse;
    LaneDivisor by;  // l
    LaneVector s, z;
  };
  struct Direction {
    LaneVector ds, dz, c, q;  // scaled
  };

  void list_contacts(const SolveState& state);
  template <class Task>
  void run_over_contacts(SolveState& state, const Task& task) const;

  std::vector<ContactLanes> contacts_;
  std::vector<int> contacts_first_;  // (chunks + 1) of SolveState::run_over_rows, by their normal rows
  std::size_t count_ = 0;            // of cones
  std::vector<Point> point_, kept_;
  bool is_kept_ = false;                             // point_ itself is the iterate to come back to
  std::vector<LaneVector> scaled_gap_, compliance_;  // of the iterate that was factored: W^-T gap; C
  std::vector<Direction> now_, before_;
  std::vector<ChunkCourse> courses_;  // scratch
  std::vector<double> worst_;         // scratch: of the chunks
};

}  // namespace cleave
