// The set that the impulses of a step problem must lie in, as the prepared step, the solve state and the
// interior point see it. (The judge has its own, residual_rows.cpp.)
//
// Every row has an interval of its own, but for contacts whose box is turned (StepProblem::box_angle_rad):
// there the impulses of the three rows (normal, t1, t2) lie in a box along axes that are turned by the angle
// in the tangent plane,
//
//     x' = F^T x,   F = | 1       |      lo <= lambda' <= hi,   w' >= 0 at lo,  w' <= 0 at hi,
//                       |   c  -s |      w' = 0 between,         c = cos angle, s = sin angle.
//                       |   s   c |
//
// Strategies work along these axes, where the set is a box; kernels and bodies see rows, where the weights of
// such a contact are a 3x3 block D = F diag(d) F^T. Without turned boxes both are the same numbers and
// nothing is copied.
//
// The rows of a contact with a cone (StepProblem::contact_set) stand as they are; their set is cone.h's.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solver/friction_cone.h"
#include "solver/row_weights.h"
#include "solver/step_problem.h"

namespace cleave {

// Of cones, ascending, those whose normal is one of the rows first .. last - 1.
std::span<const FrictionCone> cones_between(std::span<const FrictionCone> cones, int first, int last);

class ImpulseSet {
 public:
  // problem must outlive this object.
  void bind(const StepProblem& problem);

  // F of every turned box, ascending; empty where every row has an interval of its own.
  std::span<const WeightBlock> axes() const { return axes_; }

  // Of every contact whose set is no box, ascending.
  std::span<const FrictionCone> cones() const { return cones_; }
  // Those whose normal is one of the rows first .. last - 1.
  std::span<const FrictionCone> cones_of(int first, int last) const {
    return cones_between(cones_, first, last);
  }
  // visit(first, last) for the runs of rows that belong to no cone.
  template <class Visit>
  void visit_intervals(int first, int last, const Visit& visit) const;
  // Whether one of them follows Coulomb's law.
  bool has_coulomb() const { return std::ranges::any_of(cones_, &FrictionCone::coulomb); }
  // Whether a contact's weights are a block (row_weights.h).
  bool has_blocks() const { return !axes_.empty() || !cones_.empty(); }

  // (m) from rows to axes and back; F is orthonormal, so impulses, slacks and right-hand sides turn alike.
  void to_axes(std::span<double> x) const { to_basis(axes_, x); }
  void to_rows(std::span<double> x) const { from_basis(axes_, x); }
  // x (m, along the axes) in rows: x itself without turned boxes, else in scratch.
  std::span<const double> in_rows(std::span<const double> x, std::vector<double>& scratch) const;

  // impulse (m, along the axes) <- the nearest point of the set, of all rows or of first .. last - 1, which a
  // cone belongs to with its normal row.
  void project(std::span<double> impulse) const { project(0, static_cast<int>(impulse.size()), impulse); }
  void project(int first, int last, std::span<double> impulse) const;

  // max_r d_r |lambda_r - projection of (lambda_r - w_r / d_r)| of rows first .. last - 1; arrays (m) along
  // the axes. A cone is projected on as a whole and is of the range that its normal row is in; Coulomb's law
  // has in w what it adds (shifted_slack). NaN where one is no number.
  double residual(int first, int last, std::span<const double> d, std::span<const double> impulse,
                  std::span<const double> w) const;
  // The same, and the sum of F_r^2 / d_r of the rows and contacts, F_r being what residual() is the largest
  // of.
  struct Misses {
    double largest = 0;  // m/s
    double energy = 0;   // J
  };
  Misses misses(int first, int last, std::span<const double> d, std::span<const double> impulse,
                std::span<const double> w) const;

 private:
  const StepProblem* problem_ = nullptr;
  std::vector<WeightBlock> axes_;
  std::vector<FrictionCone> cones_;
};

template <class Visit>
void ImpulseSet::visit_intervals(int first, int last, const Visit& visit) const {
  const auto end_of = [](const FrictionCone& cone) { return cone.first_row + cone.row_count; };
  auto cone = std::ranges::upper_bound(cones_, first, {}, end_of);
  int row = first;
  for (; cone != cones_.end() && cone->first_row < last; ++cone) {
    if (cone->first_row > row) visit(row, cone->first_row);
    row = end_of(*cone);
  }
  if (row < last) visit(row, last);
}

// The sets that an algorithm takes; one that takes a kind takes those before it.
enum class SetKind { intervals, turned_boxes, cones };

// The last kind of which a problem has a set.
SetKind hardest_set(const StepProblem& problem);

// Why an algorithm that takes sets of this kind refuses a problem; empty where it has no others. kind and
// name as in "strategy" "pivot".
std::string find_set_refusal(std::string_view kind, std::string_view name, const StepProblem& problem,
                             SetKind taken = SetKind::intervals);

}  // namespace cleave
