// The iterate of the interior-point method and its Newton direction, on
//
//     min 1/2 lambda^T (J M^-1 J^T + C) lambda - (b - J v0)^T lambda,   lo <= lambda <= hi.
//
// Every finite bound beta of a row is a pair of a slack s and a multiplier z, both positive and kept as
// variables (recomputing s from lambda loses all digits near the bound). With sigma = 1 for a lower and -1
// for an upper bound the conditions are
//
//     J v + C lambda - b - sum sigma z = 0,    s = sigma (lambda - beta),    s z = mu -> 0.
//
// Eliminating the changes of slack and multiplier,
//
//     ds = sigma dlambda + gap,   gap = sigma (lambda - beta) - s,   dz = (c - z ds) / s,
//
// where c is the change of s z that is aimed at, leaves the kernel's system with
// D_r = 1 / (max(C_r, delta d_r) + sum z / s). delta keeps D of rows with next to no compliance within what
// double precision can factor; as residuals are those of C, it changes the way and not the end. Rows whose
// bounds coincide are fixed; unbounded rows have no pair. Source: Mehrotra, "On the implementation of a
// primal-dual interior point method", SIAM J. Optim. 2, 1992; Gondzio, "Multiple centrality corrections in a
// primal-dual method for linear programming", Comput. Optim. Appl. 6, 1996; Friedlander and Orban, "A
// primal-dual regularized interior-point method for convex quadratic programs", Math. Program. Comput. 4,
// 2012.
//
// Rows are those along the axes of the impulse set (impulse_set.h): for a turned box the kernel gets the same
// D as a 3x3 block.
#pragma once

#include <vector>

#include "solver/solve_state.h"
#include "solver/strategies/interior_constants.h"

namespace cleave {

class InteriorIterate {
 public:
  enum class Aim { affine, mehrotra, centre };

  explicit InteriorIterate(const InteriorConstants& constants) : constants_(constants) {}

  // Impulses moved inside their bounds, slacks and multipliers to them.
  void start(SolveState& state);

  // Factors the Newton system; false when the kernel finds a non-positive pivot.
  bool factor(SolveState& state, double delta);

  // The direction to an aim: zero products; Mehrotra's target and second-order term, after `affine`; or equal
  // products to first order. One back-substitution each.
  void find_direction(SolveState& state, Aim aim);

  // The largest residual of the direction in the rows of its own system, m/s: what rounding did to it.
  double rounding(SolveState& state);

  // Centrality corrections: where bounds cut the step, products that a longer step would leave far from the
  // target are aimed back, with the factor at hand, while the step grows.
  void correct_centrality(SolveState& state);

  double largest_step() const { return largest_step_; }  // along the direction, before a variable is zero
  double mean_product(double step) const;                // of s z, after such a step
  void advance(SolveState& state, double step);

  // The largest violation of the conditions as a velocity (m/s): of the equation in w, and min(d s, z).
  double error(const SolveState& state);

  // A row is at a bound where the multiplier outweighs the slack, else free.
  void read_active_set(SolveState& state) const;

  // One iterate, to come back to.
  void keep(const SolveState& state);
  void restore(SolveState& state);

 private:
  struct Pair {
    int row;
    double sign, bound;  // sigma, beta
  };
  struct Direction {
    std::vector<double> ds, dz, c, dlambda;
  };

  void choose_impulses(SolveState& state);
  void add_pairs(SolveState& state, int row, double speed);
  void set_products(Aim aim);
  void set_right_hand_side(SolveState& state);
  void solve(SolveState& state);
  void measure_direction();

  InteriorConstants constants_;
  std::vector<Pair> pairs_;  // ascending row
  std::vector<char> fixed_;  // (m)
  std::vector<double> s_, z_;
  std::vector<double> inverse_s_, inverse_z_, gap_;  // of the iterate that was factored
  Direction now_, before_;
  double target_ = 0;  // product that Mehrotra's direction aims at
  // Of the direction: where it ends, and the sum of s z along it, sum_[0] + sum_[1] step + sum_[2] step^2.
  double largest_step_ = 1, sum_[3] = {};
  std::vector<double> kept_impulse_, kept_s_, kept_z_;
  std::vector<double> row_error_;
  std::vector<double> change_;  // (n, 6) M^-1 J^T dlambda
};

}  // namespace cleave
