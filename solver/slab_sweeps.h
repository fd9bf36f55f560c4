// Projected Gauss-Seidel sweeps for several threads: the predictor of the active-set strategies. One row is
//
//     w_r = J_r v + C_r lambda_r - b_r,   lambda_r <- clamp(lambda_r - omega w_r / d_r, lo_r, hi_r),   v += M^-1 J_r^T dlambda
//
// as in gauss_seidel.h, where rows come in their natural order and omega is 1 (over-relaxation: Cryer 1971). Here bodies are cut into slabs, by their distance in the
// graph from a body at its edge, so that rows between two bodies are inside of a slab or between two that are
// neighbours. A sweep is
//
//     the insides of all slabs;   the gaps between slabs 0|1, 2|3, ...;   the gaps 1|2, 3|4, ...
//
// and every inside or gap a task, which waits for those that share bodies with it alone: slabs at one end may be a sweep
// ahead of the other. A task visits its groups of rows (those between two bodies) colour after colour. Groups of a colour
// share no dynamic body, and six of them are worked on side by side, so that arithmetic units wait less. Order and bytes
// depend on the problem alone, not on the number of threads. Numbers are of single precision, half the memory that a
// sweep goes through: what comes out is a guess of the active set, and solved exactly afterwards.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "solver/parallel_tasks.h"
#include "solver/prepared_step.h"
#include "solver/slab_rows.h"

namespace cleave {

class SlabSweeps {
 public:
  static constexpr int kMostSweeps = 5;  // of one run
  // Factorisations that follow the sweeps of `pivot`, and sweeps: with 1.2 a tenth fewer and a twentieth more than with 1, on
  // runs of piles, towers and chains; a silo takes some more of both. 1.1 and 1.3 gain about as much.
  static constexpr double kOverRelaxation = 1.2;

  // Of a problem without turned boxes, which must stay as it is for run().
  void bind(const PreparedStep& step, ParallelTasks& tasks);

  // What run() goes on from: impulse (m) and v = v0 + M^-1 J^T impulse (n, 6).
  void take_in(std::span<const double> impulse, std::span<const double> v, ParallelTasks& tasks);
  // Sweeps, at most kMostSweeps. Returns how many rows have come to or left a bound since the run before, or take_in().
  // beside: one more task, for work that has nothing to do with the sweeps. Ends with SolveStopped where tasks say so.
  int run(
      int sweeps, ParallelTasks& tasks, const std::function<void()>& beside = [] {});
  // Impulses, those at a bound exactly there, and v to single precision.
  void give_out(std::span<double> impulse, std::span<double> v, ParallelTasks& tasks) const;

  int slab_count() const { return slab_count_; }
  std::span<const int> slab_of_body() const { return slab_of_body_; }
  // Sets of groups: insides 0 .. slab_count() - 1, then gaps.
  int set_count() const { return 2 * slab_count_ - 1; }
  int color_count(int set) const { return color_first_[set + 1] - color_first_[set]; }
  std::span<const int> groups_of(int set, int color) const {
    const int* first = group_first_.data() + color_first_[set] + color;
    return std::span(groups_).subspan(first[0], first[1] - first[0]);
  }

 private:
  void measure_distances(const PreparedStep& step);
  int walk_from(const PreparedStep& step, int start, int distance);
  void cut_slabs(const PreparedStep& step);
  void color_groups(const PreparedStep& step);
  void sort_groups(const PreparedStep& step, ParallelTasks& tasks);
  void assign_places(const PreparedStep& step);
  void pack_rows(const PreparedStep& step, int set);
  int update_sides(int set);
  template <class ForBody, class ForGroup>
  void run_over_chunks(ParallelTasks& tasks, const ForBody& for_body, const ForGroup& for_group) const;
  int set_of_gap(int gap) const;
  void build_graph();

  const PreparedStep* step_ = nullptr;
  int slab_count_ = 0;
  std::vector<int> slab_of_body_;
  std::vector<int> color_first_;  // of each set, in group_first_
  std::vector<int> group_first_;  // of each colour, in groups_
  std::vector<int> groups_;       // by set, colour, and longest first
  std::vector<int> place_of_body_, place_of_group_;
  std::vector<SlabBody> bodies_;   // by place, then one that stands still
  std::vector<SlabRow> rows_;      // by place, in the order of groups_
  std::vector<float> impulse_;     // by place
  std::vector<signed char> side_;  // by place: at its lower bound, free, at its upper one
  std::vector<int> changed_;       // by set, in the last run
  TaskGraph graph_;                // of kMostSweeps sweeps, and what is done beside them
  // Scratch.
  std::vector<int> distance_, queue_, rows_at_, slab_first_, set_of_group_, color_of_group_, group_count_;
  std::vector<std::uint64_t> used_colors_;  // a bit a colour, by body
  std::vector<std::pair<int, int>> waits_;
  std::vector<double> places_;
};

}  // namespace cleave
