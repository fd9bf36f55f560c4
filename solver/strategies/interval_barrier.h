// The barrier of the bounds along the axes of the impulse set; contacts with a cone have cone_barrier.h's.
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
//
//     D_r = 1 / (C_r + sum z / s),   f_r = -w + sum sigma (z + (c - z gap) / s).
//
// Loops over pairs are dealt out in the ranges of SolveState::run_over_rows; a row's pairs are of its range.
//
// Rows whose bounds coincide are fixed, with D = 0; unbounded rows and those of cones have no pair.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/solve_state.h"
#include "solver/strategies/interior_constants.h"

namespace cleave {

// Along a direction: the step at which the first variable is zero, and the sum of all s z, which is
// product[0] + product[1] step + product[2] step^2.
struct BarrierCourse {
  double largest_step = 1;
  double product[3] = {};
};

// Of the ranges of rows together; their largest steps are inverses.
BarrierCourse join_courses(std::span<const BarrierCourse> ranges);

class IntervalBarrier {
 public:
  explicit IntervalBarrier(const InteriorConstants& constants) : constants_(constants) {}

  // Impulses moved inside their bounds, slacks and multipliers to them; speed (m): what d s and z of a row
  // are at least, m/s.
  void start(SolveState& state, std::span<const double> speed);

  // weight (m): the compliance that is factored in, D out; on the rows of cones 1 / D in. Fixes s, z and gap for the
  // directions that follow.
  void weigh(SolveState& state, std::span<double> weight);

  // Products s z that the direction aims at, less the second-order term of the last direction or not.
  void aim(SolveState& state, double product, bool second_order);
  void right_hand_side(SolveState& state) const;  // state.f_r from state.slack
  BarrierCourse follow(SolveState& state);        // ds and dz from state.dlambda; returns where they lead

  // Aims products that a step of `trial` would leave outside of [low, high] back at it.
  void correct(SolveState& state, double trial, double low, double high);
  void keep_direction() { before_ = now_; }
  void restore_direction() { now_ = before_; }

  void advance(SolveState& state, double step);  // impulses, slacks and multipliers
  // row_error (m): what is left of the equation in w. Returns the largest min(d s, z).
  double error(SolveState& state, std::span<double> row_error);

  // A row is at a bound where the multiplier outweighs the slack, else free.
  void read_active_set(SolveState& state) const;

  // One iterate, to come back to.
  void keep() { kept_s_ = s_, kept_z_ = z_; }
  void restore() { s_ = kept_s_, z_ = kept_z_; }

  bool is_fixed(std::size_t row) const { return use_[row] == RowUse::fixed; }
  bool is_of_cone(std::size_t row) const { return use_[row] == RowUse::of_cone; }
  std::size_t product_count() const { return pairs_.size(); }

 private:
  struct Pair {
    int row;
    double sign, bound;  // sigma, beta
  };
  struct Direction {
    std::vector<double> ds, dz, c;
  };
  enum class RowUse : std::uint8_t { bounded, fixed, of_cone };

  void add_pairs(SolveState& state, int row, double speed);
  template <class Task>
  void run_over_pairs(SolveState& state, const Task& task) const;
  void follow_range(int first, int last, std::span<const double> dlambda, BarrierCourse& course);

  InteriorConstants constants_;
  std::vector<Pair> pairs_;             // ascending row
  std::vector<int> pair_first_;         // (ranges + 1)
  std::vector<BarrierCourse> courses_;  // scratch: of the ranges, largest_step its inverse
  std::vector<double> worst_;           // scratch: of the ranges
  std::vector<RowUse> use_;             // (m)
  std::vector<double> s_, z_;
  std::vector<double> inverse_s_, inverse_z_, gap_;  // of the iterate that was factored
  Direction now_, before_;
  std::vector<double> kept_s_, kept_z_;
};

}  // namespace cleave
