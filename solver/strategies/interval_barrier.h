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
// Lower and upper bounds are a side each, with a place for every row, so that loops over them are vector
// instructions without gathering. Where a row has no such bound its place holds s = 1 and zeros, which add
// nothing. Who calls deals out the rows.
//
// Rows whose bounds coincide are fixed, with D = 0.
#pragma once

#include <array>
#include <cstddef>
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

// The same of the rows of a chunk: the inverse of that step, at least 1, so that variables which do not fall
// need no infinity.
struct ChunkCourse {
  double inverse_step = 1;
  double product[3] = {};
};
BarrierCourse join_courses(std::span<const ChunkCourse> chunks);

class IntervalBarrier {
 public:
  explicit IntervalBarrier(const InteriorConstants& constants) : constants_(constants) {}

  // Impulses moved inside their bounds, slacks and multipliers to them; speed (m): what d s and z of a row
  // are at least, m/s.
  void start(SolveState& state, std::span<const double> speed);

  // Of these rows, state.weight: the compliance that is factored in, D out; on the rows of cones 1 / D in.
  // Fixes s, z and gap for the directions that follow.
  void weigh(SolveState& state, int first, int last);

  // Of these rows: products s z that the direction aims at, less the second-order term of the last direction
  // or not, and state.f_r for it.
  void aim(SolveState& state, int first, int last, double product, bool second_order);
  void right_hand_side(SolveState& state, int first, int last) const;  // state.f_r anew
  // ds and dz from state.dlambda; returns where they lead.
  ChunkCourse follow(const SolveState& state, int first, int last);

  // After swap_directions, of these rows: aims products that a step of `trial` would leave outside of [low,
  // high] back at it, with state.f_r.
  void correct(SolveState& state, int first, int last, double trial, double low, double high);
  void swap_directions();  // with the direction from before

  void advance(SolveState& state, int first, int last, double step);  // impulses, slacks and multipliers
  // Of these rows, the largest of min(d s, z) and of what is left of the equation in w, m/s; row_error (m):
  // scratch.
  double error(const SolveState& state, int first, int last, std::span<double> row_error) const;

  // A row is at a bound where the multiplier outweighs the slack, else free.
  void read_active_set(SolveState& state) const;

  // One iterate, to come back to.
  void keep(int first, int last);  // rows
  void restore();

  bool is_fixed(std::size_t row) const { return use_[row] == RowUse::fixed; }
  bool is_of_cone(std::size_t row) const { return use_[row] == RowUse::of_cone; }
  std::size_t product_count() const { return bounds_; }

 private:
  struct Direction {
    std::vector<double> ds, dz, c;
  };
  // The lower or the upper bounds of all rows.
  struct Side {
    explicit Side(double sign_of_bound) : sign(sign_of_bound) {}
    void resize(std::size_t rows);
    void start(int first, int last);  // without bounds
    void add(int row, double value, double impulse, double multiplier);
    void weigh(int first, int last, std::span<const double> impulse, std::span<double> weight);
    void aim(int first, int last, double product, double share);
    void add_force(int first, int last, std::span<double> f_r) const;
    void follow(int first, int last, std::span<const double> dlambda, ChunkCourse& course);
    void correct(int first, int last, double trial, double low, double high);
    double error(int first, int last, std::span<const double> d, std::span<double> row_error) const;
    void keep(int first, int last);
    std::array<std::vector<double>*, 14> zeros_at_start();

    double sign;                                    // sigma
    std::vector<double> is_there;                   // 1, or 0 where a row has no such bound
    std::vector<double> bound, s, z;                // beta
    std::vector<double> inverse_s, inverse_z, gap;  // of the iterate that was factored
    Direction now, before;
    std::vector<double> kept_s, kept_z;
  };
  enum class RowUse : std::uint8_t { bounded, fixed, of_cone };

  int add_bounds(SolveState& state, int row, double speed);  // returns how many it has added
  // None where no row has a bound.
  std::span<Side> sides() { return std::span(sides_).first(bounds_ > 0 ? 2 : 0); }
  std::span<const Side> sides() const { return std::span(sides_).first(bounds_ > 0 ? 2 : 0); }

  InteriorConstants constants_;
  std::array<Side, 2> sides_ = {Side(1), Side(-1)};  // lower, upper
  std::size_t bounds_ = 0;                           // finite ones
  std::vector<int> chunk_bounds_;                    // the same of every chunk of rows
  std::vector<RowUse> use_;                          // (m)
  std::vector<double> moves_;                        // (m) 0 where a row is fixed, else 1
};

}  // namespace cleave
