// The factor of a sparse symmetric matrix of blocks, column by column: elimination order, elimination tree,
// and which rows a column has.
//
// The order reduces fill: minimum degree, and where that leaves a factorisation so large that it is worth the
// time of looking for a better order, nested dissection if it leaves less and there are no stages
// (elimination_order.h). It is then made a postorder of the tree, so that every subtree is contiguous.
// Positions are places in that order.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/elimination_order.h"
#include "solver/memory_count.h"

namespace cleave {

class ColumnStructure {
 public:
  // As BlockSymbolic::analyze. False where there are more than most_blocks.
  bool analyze(int node_count, std::span<const std::pair<int, int>> edges, std::span<const int> stage_of_node,
               long most_blocks);
  void count(MemoryCount& memory) const;

  int node_count() const { return node_count_; }
  std::span<const int> position_of_node() const { return position_of_node_; }
  std::span<const int> node_at_position() const { return node_at_position_; }
  int parent(int position) const { return parent_[position]; }  // -1 for a root
  // Positions below the diagonal, ascending.
  std::span<const int> rows_below(int position) const {
    return std::span(column_rows_)
        .subspan(column_first_[position], column_first_[position + 1] - column_first_[position]);
  }
  // Of the factor, diagonal blocks whole; of as many columns as were analysed.
  long block_count() const { return block_count_; }
  // Sum of squared column counts over the six columns of a block column.
  double flops(int position) const;

 private:
  void build_adjacency(std::span<const std::pair<int, int>> edges);
  BlockGraph graph() const { return {adjacency_first_, adjacency_}; }
  std::span<const int> number_stages(std::span<const int> stage_of_node);
  bool find_columns(long most_blocks);
  bool choose_order(bool fits, long most_blocks);
  double all_flops() const;
  void find_elimination_tree();
  void postorder();
  bool find_structures(long most_blocks);

  int node_count_ = 0;
  std::vector<int> adjacency_first_, adjacency_;  // by node, both directions, ascending
  std::vector<int> position_of_node_, node_at_position_;
  std::vector<int> parent_;  // by position
  std::vector<long> column_first_;
  std::vector<int> column_rows_;
  long block_count_ = 0;
  std::vector<int> mark_, head_, next_, stack_;  // scratch
  std::vector<int> order_by_degree_;             // scratch: while another one is tried
};

}  // namespace cleave
