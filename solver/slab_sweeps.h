// Projected Gauss-Seidel sweeps for several threads: the predictor of the strategy `pivot`. One row is
//
//     w_r = J_r v + C_r lambda_r - b_r
//     lambda_r <- clamp(lambda_r - w_r / d_r, lo_r, hi_r)
//     v += M^-1 J_r^T dlambda_r
//
// as in gauss_seidel.h, where rows come in their natural order; from one sweep to the next with momentum
// (sweep_momentum.h). Bodies are cut into slabs (slabs.h), and the rows of an inside or a gap are one task of
// a sweep. A task visits its groups of rows (those between two bodies) in octets: up to eight groups of about
// as many rows, of which no two share a dynamic body, in the lanes of a vector. Order and bytes depend on the
// problem alone, not on the number of threads. Numbers are of single precision, half the memory that a sweep
// goes through: what comes out is a guess of the active set, and solved exactly afterwards.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/parallel_tasks.h"
#include "solver/prepared_step.h"
#include "solver/slab_rows.h"
#include "solver/slabs.h"
#include "solver/sweep_momentum.h"

namespace cleave {

class SlabSweeps {
 public:
  static constexpr int kMostSweeps = 60;  // of one run
  static constexpr int kSweepsOfALook = 5;

  // Of a problem without turned boxes, which must stay as it is for run().
  void bind(const PreparedStep& step, ParallelTasks& tasks);

  // What run() goes on from: impulse (m) and v = v0 + M^-1 J^T impulse (n, 6).
  void take_in(std::span<const double> impulse, std::span<const double> v, ParallelTasks& tasks);
  // Sweeps, at most kMostSweeps. After every kSweepsOfALook of them, and after the last, rows that have come
  // to or left a bound since the look before, or take_in(), are counted; no more than settled_rows, and the
  // run ends. Returns the last count. Ends with Stopped where tasks say so.
  int run(int sweeps, int settled_rows, ParallelTasks& tasks);
  // Impulses, those at a bound exactly there, and v to single precision.
  void give_out(std::span<double> impulse, std::span<double> v, ParallelTasks& tasks) const;

  const Slabs& slabs() const { return slabs_; }
  int octet_count(int set) const { return octet_count_[set]; }
  std::span<const int> groups_of_set(int set) const {
    return std::span(groups_).subspan(group_first_[set], group_first_[set + 1] - group_first_[set]);
  }
  // Its place among the octets of its set, which are visited in their order.
  int octet_of_group(int group) const;

 private:
  void sort_groups(const PreparedStep& step);
  void fill_octets(const PreparedStep& step, int set);
  void assign_places(const PreparedStep& step);
  void pack_rows(const PreparedStep& step, int set);
  void pack_group(const PreparedStep& step, int group);
  void visit(int set);
  void end_sweep(bool looks, int settled_rows);
  int update_sides(int set);
  std::span<Octet> octets_of(int set) {
    return std::span(octets_).subspan(group_first_[set], octet_count_[set]);
  }
  template <class ForBody, class ForGroup>
  void run_over_chunks(ParallelTasks& tasks, const ForBody& for_body, const ForGroup& for_group) const;

  // Of every lane of an octet's row: at its lower bound, free, at its upper one. What looks alone read stands
  // apart from what every sweep goes through.
  using RowSides = std::array<signed char, kOctetLanes>;

  const PreparedStep* step_ = nullptr;
  Slabs slabs_;
  std::vector<int> group_first_;     // of each set, in groups_
  std::vector<int> groups_;          // by set, then the longest first, then as in the step
  std::vector<Octet> octets_;        // those of a set from group_first_[set] on
  std::vector<int> octet_count_;     // by set
  std::vector<int> row_first_;       // of each set, in rows_, and the end
  std::vector<int> place_of_group_;  // 8 octet row + lane of its first row
  std::vector<int> place_of_body_;
  std::vector<OctetRow> rows_;    // by set and octet
  std::vector<RowSides> sides_;   // of rows_
  std::vector<SlabBody> bodies_;  // by place: those of a slab side by side, then one a set that stands still
  SweepMomentum momentum_;
  std::vector<double> agreement_;  // by set, of the last sweep (sweep_momentum.h)
  std::vector<int> changed_;       // by set, at the last look
  int changed_rows_ = 0;           // of all
  bool is_settled_ = false;
  std::vector<int> slab_first_, bodies_by_slab_, bucket_first_;  // scratch
};

}  // namespace cleave
