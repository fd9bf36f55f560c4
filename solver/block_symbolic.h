// Symbolic analysis of a sparse symmetric matrix of 6x6 blocks: elimination order, elimination tree,
// supernodes.
//
// Nodes are bodies, an off-diagonal block stands for a pair of bodies that share a row. The order reduces
// fill (approximate minimum degree, Amestoy, Davis, Duff 1996); columns with (nearly) the same structure are
// joined into supernodes, so that the numeric factorisation runs on dense panels. Positions are places in the
// elimination order; all indices below are in blocks.
//
// Stages: nodes may carry a stage number; all nodes of a lower stage are eliminated before those of the last
// stage, and supernodes never span two stages. Nodes of different stages below the last must not be adjacent:
// those stages are then independent subtrees that may be factored in parallel.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace cleave {

struct Supernode {
  int first_position = 0;  // own columns: positions first_position .. first_position + width - 1
  int width = 0;
  int first_row = 0;  // rows()[first_row .. first_row + row_count): own columns first, then the rows below
  int row_count = 0;
  int parent = -1;  // supernode that takes the update matrix; -1 for a root
  int stage = 0;
  int first_descendant = 0;  // the subtree is supernodes first_descendant .. this one (postorder)
  long panel_offset = 0;     // in doubles, into the factor
  long update_offset = 0;    // in doubles, into the update stack
  int rows_below() const { return row_count - width; }
};

class BlockSymbolic {
 public:
  // edges: pairs of distinct nodes, duplicates allowed. stage_of_node: (n) stages 0..stage_count-1, or empty
  // for one stage. Throws nothing; buffers are kept for the next analysis.
  void analyze(int node_count, std::span<const std::pair<int, int>> edges,
               std::span<const int> stage_of_node = {}, int stage_count = 1);

  int node_count() const { return node_count_; }
  std::span<const int> position_of_node() const { return position_of_node_; }
  std::span<const int> node_at_position() const { return node_at_position_; }
  std::span<const Supernode> supernodes() const { return supernodes_; }
  std::span<const int> supernode_at_position() const { return supernode_at_position_; }
  std::span<const int> rows() const { return rows_; }
  // For each entry of rows() below the own columns: its index in the parent's row list.
  std::span<const int> row_in_parent() const { return row_in_parent_; }
  // Children of a supernode, ascending.
  std::span<const int> children(int supernode) const {
    return std::span(children_).subspan(child_first_[supernode],
                                        child_first_[supernode + 1] - child_first_[supernode]);
  }
  // Supernodes of one stage: a contiguous range [first, last).
  std::pair<int, int> stage_range(int stage) const { return {stage_first_[stage], stage_first_[stage + 1]}; }
  // First position of the last stage; node_count() when that stage is empty.
  int last_stage_position() const {
    const int first = stage_first_[stage_first_.size() - 2];
    return first == static_cast<int>(supernodes_.size()) ? node_count_ : supernodes_[first].first_position;
  }
  // Positions of the last stage that supernodes of an earlier one have rows at, ascending; and for each entry
  // of rows() there, its index among those of its stage.
  std::span<const int> late_positions(int stage) const {
    return std::span(late_positions_)
        .subspan(late_first_[stage], late_first_[stage + 1] - late_first_[stage]);
  }
  std::span<const int> late_index() const { return late_index_; }
  int stage_count() const { return static_cast<int>(stage_first_.size()) - 1; }

  long factor_size() const { return factor_size_; }  // doubles of all panels
  long update_size() const { return update_size_; }  // doubles of the update stacks
  double factor_flops(int stage) const {
    return stage_flops_[stage];
  }  // sum of squared column counts, no padding

 private:
  void build_adjacency(std::span<const std::pair<int, int>> edges);
  void order(std::span<const int> stage_of_node);
  void find_elimination_tree();
  void postorder(std::span<const int> stage_of_node, int stage_count);
  void find_structures();
  void find_supernodes(std::span<const int> stage_of_node, int stage_count);
  void list_rows();
  void list_late_rows();
  void place_storage();

  int node_count_ = 0;
  std::vector<int> adjacency_first_, adjacency_;  // by node, both directions, ascending
  std::vector<int> position_of_node_, node_at_position_;
  std::vector<int> parent_;                      // elimination tree by position
  std::vector<int> column_first_, column_rows_;  // structure below the diagonal by position, ascending
  std::vector<Supernode> supernodes_;
  std::vector<int> supernode_at_position_;
  std::vector<int> rows_, row_in_parent_;
  std::vector<int> late_first_, late_positions_, late_index_;
  std::vector<int> child_first_, children_, stage_first_;
  std::vector<double> stage_flops_;
  long factor_size_ = 0, update_size_ = 0;
  std::vector<int> mark_, head_, next_, stack_;  // scratch
  std::vector<long> true_blocks_;                // scratch: blocks of a supernode that are not padding
};

}  // namespace cleave
