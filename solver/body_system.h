// The system of a kernel over the bodies of a step, as products that need no matrix:
//
//     H = M + J'^T D J',   right-hand side f_v + J'^T D f_r,   dlambda = D (f_r - J' dv)
//
// with rows as the weights turn them (row_weights.h). Every function works on some of the step's groups or
// bodies, so that they can be dealt out to threads; groups come before bodies.
#pragma once

#include <span>
#include <vector>

#include "solver/group_products.h"
#include "solver/prepared_step.h"
#include "solver/row_weights.h"

namespace cleave {

class BodySystem {
 public:
  // position: where a body stands in the vectors that are solved for, x; empty: as in the problem. Both must
  // stay.
  void bind(const PreparedStep& step, std::span<const int> position = {});
  // As RowWeights, the arrays must stay where they are. turn() of all groups comes after it.
  void set(const RowWeights& weights) { rows_.set(step_->problem(), weights); }
  void turn(const Chunk& groups) { rows_.turn(step_->rows_of(groups)); }
  const WeightedRows& rows() const { return rows_; }

  // Sums of J'^T D f_r by group, f_r (m).
  void weigh(const Chunk& groups, std::span<const double> f_r);
  // Sums of J'^T D J' x by group.
  void weigh_product(const Chunk& groups, std::span<const double> x);
  // x = f_v + the sums of all groups; f_v (n, 6) as in the problem.
  void collect(const Chunk& bodies, std::span<const double> f_v, std::span<double> x) const;
  void collect(std::span<const int> bodies, std::span<const double> f_v, std::span<double> x) const;
  // out = M x + the sums of all groups.
  void collect_product(const Chunk& bodies, std::span<const double> x, std::span<double> out) const;
  // dlambda (m) = D (f_r - J' x)
  void expand(const Chunk& groups, std::span<const double> x, std::span<const double> f_r,
              std::span<double> dlambda) const;
  // From positions to the order of the problem and back.
  void to_bodies(std::span<const int> bodies, std::span<const double> x, std::span<double> by_body) const;
  void to_positions(std::span<const int> bodies, std::span<const double> by_body, std::span<double> x) const;

 private:
  long place(int body) const { return 6L * (position_.empty() ? body : position_[body]); }
  BodyPair load(const RowGroup& group, std::span<const double> x) const;
  void collect_body(int body, std::span<const double> f_v, std::span<double> x) const;

  const PreparedStep* step_ = nullptr;
  std::span<const int> position_;
  WeightedRows rows_;
  std::vector<double> group_sums_;  // (groups, 12)
};

}  // namespace cleave
