// The iterate of the interior-point method and its Newton direction, on
//
//     min 1/2 lambda^T (J M^-1 J^T + C) lambda - (b - J v0)^T lambda,   lo <= lambda <= hi;
//
// contacts with a cone have |lambda_t| <= mu lambda_n in place of bounds. Slacks and multipliers of the
// bounds, their part of D and of the right-hand side are interval_barrier.h's, those of the cones
// cone_barrier.h's; this file chooses what their products aim at and how far to step. D_r = 1 / (max(C_r,
// delta d_r) + sum z / s), where delta keeps D of rows with next to no compliance within what double
// precision can factor; as residuals are those of C, it changes the way and not the end. Source: Mehrotra,
// "On the implementation of a primal-dual interior point method", SIAM J. Optim. 2, 1992; Gondzio, "Multiple
// centrality corrections in a primal-dual method for linear programming", Comput. Optim. Appl. 6, 1996;
// Friedlander and Orban, "A primal-dual regularized interior-point method for convex quadratic programs",
// Math. Program. Comput. 4, 2012.
//
// Rows are those along the axes of the impulse set (impulse_set.h): for a turned box the kernel gets the same
// D as a 3x3 block.
#pragma once

#include <vector>

#include "solver/solve_state.h"
#include "solver/strategies/cone_barrier.h"
#include "solver/strategies/coulomb_shift.h"
#include "solver/strategies/interior_constants.h"
#include "solver/strategies/interval_barrier.h"

namespace cleave {

class InteriorIterate {
 public:
  enum class Aim { affine, mehrotra, centre };

  explicit InteriorIterate(const InteriorConstants& constants) : constants_(constants), barrier_(constants) {}

  // Impulses moved inside their bounds, slacks and multipliers to them. inside: factor of the products s z
  // that they start with.
  void start(SolveState& state, double inside = 1);

  // Factors the Newton system; false when the kernel finds a non-positive pivot.
  bool factor(SolveState& state, double delta);

  // The direction to an aim: zero products; Mehrotra's target and second-order term, after `affine`; or equal
  // products to first order. One back-substitution each.
  void find_direction(SolveState& state, Aim aim);

  // Turns the direction into one of Coulomb's law (coulomb_shift.h): back-substitutions until the shift that
  // it was found with and the one that it leads to differ by less than `tolerance`, m/s, or `most` of them.
  void match_shift(SolveState& state, double tolerance, int most);

  // The largest residual of the direction in the rows of its own system, m/s: what rounding did to it.
  double rounding(SolveState& state);

  // Centrality corrections: where bounds cut the step, products that a longer step would leave far from the
  // target are aimed back, with the factor at hand, while the step grows.
  void correct_centrality(SolveState& state);

  // Along the direction, before a variable is zero.
  double largest_step() const { return course_.largest_step; }
  double mean_product(double step) const;  // of s z, after such a step
  void advance(SolveState& state, double step);

  // The largest violation of the conditions as a velocity (m/s): of the equation in w, and min(d s, z). With
  // cones the residual, because their s and z may round more than the impulses do. Of the last start, advance
  // or restore.
  double error() const { return error_; }

  // A row is at a bound where the multiplier outweighs the slack, else free.
  void read_active_set(SolveState& state) const { barrier_.read_active_set(state); }

  // One iterate, to come back to; what is kept of intervals is copied as the next step changes it.
  void keep();
  void restore(SolveState& state);
  // Its impulses alone, with their velocities.
  void load_kept_impulses(SolveState& state) const {
    if (!is_to_be_kept_) state.load(kept_impulse_);  // else it is the present one
  }

 private:
  void choose_impulses(SolveState& state);
  void start_rows(SolveState& state, double inside);
  void choose_target(Aim aim);
  void add_cones_to_right_hand_side(SolveState& state) const;
  void solve(SolveState& state, const RowWork& set_force);  // which sets the part of the bounds in state.f_r
  void update_velocity(SolveState& state, const RowWork& move = {});  // which writes the impulses
  void measure(SolveState& state);

  InteriorConstants constants_;
  IntervalBarrier barrier_;
  ConeBarrier cones_;
  CoulombShift shift_;
  BarrierCourse course_, kept_course_;  // of the direction
  std::vector<ChunkCourse> courses_;    // scratch: of the bounds in every chunk
  double target_ = 0;                   // product that Mehrotra's direction aims at
  double error_ = 0;                    // of the present iterate
  bool is_to_be_kept_ = false;          // which is the one to come back to
  std::vector<double> kept_impulse_, kept_dlambda_;
  std::vector<double> row_speed_, row_error_, chunk_energy_;
  std::vector<double> change_;        // (n, 6) M^-1 J^T dlambda
  std::vector<double> wanted_shift_;  // (cones)
};

}  // namespace cleave
