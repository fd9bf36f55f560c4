// One part of kernel `schur-rows` (schur_rows.cpp): its bodies are eliminated with the rows inside it, and
// what the cut rows see of them is left to the interface. With H = M + J^T D J = L L^T of this part alone and
// J_c its side of the active cut rows,
//
//     Y = L^-1 J_c^T,   J_c H^-1 J_c^T = Y^T Y,   J_c H^-1 g = Y^T L^-1 g,   dv = L^-T (L^-1 g + Y lambda_c),
//
// so that one half of every later solve is a product with Y. Right-hand side k is column k of Y; they are
// sorted by the supernode of their body, so that those that reach a supernode, which come from its subtree,
// are a contiguous range.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/block_matrix.h"
#include "solver/interface_split.h"
#include "solver/kept_weights.h"
#include "solver/memory_count.h"
#include "solver/row_weights.h"

namespace cleave {

class SchurPart {
 public:
  // Part `index` of the split. step and split must stay where they are; not analysed where the factor takes
  // more than the limit.
  void analyze(const PreparedStep& step, const InterfaceSplit& split, int index, std::uint64_t limit_bytes);
  // The same, which keeps the last analysis where the bodies are the same and their rows fit its pattern.
  void rebind(const PreparedStep& step, const InterfaceSplit& split, int index, std::uint64_t limit_bytes);
  bool is_analyzed() const { return analyzed_; }
  // Matrix and factor; what else a part takes where every cut row is active.
  void count(MemoryCount& memory) const { matrix_.count(memory); }
  static void count_right_hand_sides(const PartRows& rows, MemoryCount& memory);
  void allocate() { matrix_.allocate(); }

  // all: nothing of the last factorisation stands. Else the part is made anew where a weight inside it is not
  // the one that was kept.
  void assemble(const WeightedRows& rows, bool all, KeptWeights& kept);
  void factor() {
    if (is_remade_) factored_ = matrix_.factor();
  }
  bool is_factored() const { return factored_; }
  double factor_flops() const { return matrix_.cholesky().symbolic().factor_flops(0); }
  double done_flops() const { return is_remade_ ? factor_flops() : 0; }  // of the last factorisation

  // Y and its Gram matrix, which stand where the part does and the same cut rows are active. interface_row:
  // of every cut row, its row of S; -1 where it has none.
  void form_complement(const WeightedRows& rows, std::span<const int> interface_row);
  // Of every right-hand side, its row of S; and the right-hand sides in the order of these rows.
  std::span<const int> interface_rows() const { return interface_row_; }
  std::span<const int> by_interface_row() const { return by_interface_row_; }
  // -J_c H^-1 J_c^T of two right-hand sides.
  double minus_gram(long k, long l) const { return minus_gram_[std::max(k, l) + std::min(k, l) * ld_]; }

  // L^-1 g of g = f_v + J^T D f_r, kept for expand(), and what it leaves to the right-hand sides, -J_c H^-1
  // g.
  void reduce(const WeightedRows& rows, std::span<const double> f_v, std::span<const double> f_r);
  std::span<const double> coupling() const { return std::span(coupling_).first(interface_row_.size()); }
  // Velocities of the bodies and impulses of the rows inside. lambda: by row of S.
  void expand(const WeightedRows& rows, std::span<const double> lambda, std::span<const double> f_r,
              std::span<double> dv, std::span<double> dlambda);

 private:
  const PartRows& part_rows() const { return split_->parts[index_]; }
  int row_of(int entry) const { return split_->cut_rows[part_rows().cut_rows[entry]]; }
  void bind(const PreparedStep& step, const InterfaceSplit& split, int index);
  int position_of(int entry) const;
  int supernode_of(int entry) const;
  void order_cut_rows();
  void choose_active(std::span<const int> interface_row);
  void find_ranges();
  void set_right_hand_sides(const WeightedRows& rows);
  void form_gram();
  void add_coupling();
  void add_impulses_of_interface();
  void add_impulses(const WeightedRows& rows, std::span<const double> f_r);
  void find_impulses(const WeightedRows& rows, std::span<const double> f_r, std::span<const double> dv,
                     std::span<double> dlambda) const;

  const PreparedStep* step_ = nullptr;
  const InterfaceSplit* split_ = nullptr;
  int index_ = 0;
  BlockMatrix matrix_;
  bool analyzed_ = false, factored_ = false;
  bool is_remade_ = false;          // by the last factorisation
  std::vector<int> order_;          // entries of PartRows::cut_rows by supernode of their body
  std::vector<int> active_;         // (right-hand sides) those of the order with a row of S
  std::vector<int> kept_active_;    // before
  std::vector<int> interface_row_;  // (right-hand sides)
  std::vector<int> by_interface_row_;
  std::vector<int> begin_;          // first right-hand side of each supernode, then their number
  std::vector<int> first_, last_;   // (supernodes) range of right-hand sides that are not zero there
  int ld_ = 0;                      // right-hand sides, padded to whole blocks of six
  std::vector<double> y_;           // Y^T: (ld, 6 bodies), right-hand sides run fastest
  std::vector<double> minus_gram_;  // -Y^T Y (ld, ld), lower triangle
  std::vector<double> velocity_;    // L^-1 g, later dv, by position
  std::vector<double> coupling_;    // -Y^T L^-1 g (ld), later -lambda_c
  std::vector<double> by_body_;
};

}  // namespace cleave
