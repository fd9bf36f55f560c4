// Projected Gauss-Seidel sweeps in an order of colours: the predictor of the active-set strategies.
//
// Groups of rows (those between two bodies) are coloured so that no two of a colour share a dynamic body. A sweep visits
// colour after colour; within one, groups neither read nor write what another writes, so that they may be worked on in
// any order, side by side on one core, whose arithmetic units wait less then, and by several threads: with the same
// bytes. One row is
//
//     w_r = J_r v + C_r lambda_r - b_r,   lambda_r <- clamp(lambda_r - w_r / d_r, lo_r, hi_r),   v += M^-1 J_r^T dlambda
//
// as in gauss_seidel.h, where the order is the natural one. Greedy colouring in the natural order: at most one colour more
// than the groups that a group meets at its bodies.
#pragma once

#include <span>
#include <vector>

#include "solver/parallel_tasks.h"
#include "solver/prepared_step.h"

namespace cleave {

class ColoredSweeps {
 public:
  // Colours the groups of a problem without turned boxes, which must stay as it is for run().
  void bind(const PreparedStep& step);

  // impulse (m) and v = v0 + M^-1 J^T impulse (n, 6) are updated in place. Ends with SolveStopped where tasks say so.
  void run(int sweeps, std::span<double> impulse, std::span<double> v, ParallelTasks& tasks) const;

  int color_count() const { return static_cast<int>(color_first_.size()) - 1; }
  // Of a colour, groups of many rows first.
  std::span<const int> groups_of(int color) const {
    return std::span(groups_).subspan(color_first_[color], color_first_[color + 1] - color_first_[color]);
  }

 private:
  void color_groups(const PreparedStep& step);
  void sort_by_color(const PreparedStep& step);
  void cut_into_chunks(const PreparedStep& step);

  const PreparedStep* step_ = nullptr;
  std::vector<double> inverse_diagonal_;  // (m)
  std::vector<int> color_of_group_, color_first_, groups_;
  std::vector<Chunk> chunks_;               // entries of groups_ of one colour
  std::vector<int> chunk_first_;            // of each colour
  std::vector<std::uint64_t> used_colors_;  // scratch: a bit a colour, by body
  std::vector<int> order_;                  // scratch
};

}  // namespace cleave
