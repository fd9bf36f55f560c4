// Symbolic analysis of a sparse symmetric matrix of 6x6 blocks: elimination order, elimination tree,
// supernodes.
//
// Nodes are bodies, an off-diagonal block stands for a pair of bodies that share a row. Columns of the factor
// (column_structure.h) with (nearly) the same rows are joined into supernodes, so that the numeric
// factorisation runs on dense panels. Positions are places in the elimination order; all indices below are in
// blocks.
//
// Stages: nodes may carry a stage number; nodes of a lower stage are eliminated before those of a higher one,
// and supernodes never span two. Where the stages are parts and the cut between them (a vertex cover), or the
// nodes of a tree of parts, their numbers are the order from the leaves to the root, and the elimination tree
// is that tree.
//
// Branches: the work is dealt out in branches of the elimination tree, each one task: a subtree of little
// work, or a single supernode above those. A branch needs its child branches first and is independent of all
// others. Branches depend on the pattern alone, so results do not depend on who works on them.
#pragma once

#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "solver/column_structure.h"
#include "solver/memory_count.h"

namespace cleave {

struct Supernode {
  int first_position = 0;  // own columns: positions first_position .. first_position + width - 1
  int width = 0;
  int row_count = 0;
  long first_row = 0;  // rows()[first_row .. first_row + row_count): own columns first, then the rows below
  int parent = -1;     // supernode that takes the update matrix; -1 for a root
  int stage = 0;
  int branch = 0;
  int first_descendant = 0;  // the subtree is supernodes first_descendant .. this one (postorder)
  long panel_offset = 0;     // in doubles, into the factor
  long update_offset = 0;    // in doubles, into the update stack
  int rows_below() const { return row_count - width; }
  // About as many multiplications and additions as its elimination takes, padding included; too many where it
  // is wide.
  double flops() const { return 216.0 * width * row_count * row_count; }
};

// Supernodes first .. last of one stage; `last` is the root of the subtree. What its columns add to positions
// above it goes to rows below the root's own columns only.
struct Branch {
  int first = 0, last = 0;
  int parent = -1;  // branch that the root's parent is in
  int stage = 0;
  int end_position = 0;  // one past the root's columns
  double place =
      0;  // share of all work that comes before it, in [0, 1): branches near each other share a subtree
  double flops = 0;         // as factor_flops(), of its columns
  int most_rows_below = 0;  // of its supernodes, in blocks
  long carry_offset = 0;    // in doubles: 6 for each row below the root's columns
};

class BlockSymbolic {
 public:
  // edges: pairs of distinct nodes, duplicates allowed. stage_of_node: (n) stages 0..stage_count-1, or empty
  // for one stage. Buffers are kept for the next analysis. False where the factor has more than most_blocks
  // blocks, padding aside: analysis ends there, and all that is known is block_count().
  bool analyze(int node_count, std::span<const std::pair<int, int>> edges,
               std::span<const int> stage_of_node = {}, int stage_count = 1, long most_blocks = kAnyBlocks);
  static constexpr long kAnyBlocks = std::numeric_limits<long>::max();

  int node_count() const { return columns_.node_count(); }
  std::span<const int> position_of_node() const { return columns_.position_of_node(); }
  std::span<const int> node_at_position() const { return columns_.node_at_position(); }
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
  // Ascending by root, so that children come before their parent.
  std::span<const Branch> branches() const { return branches_; }
  std::span<const int> child_branches(int branch) const {
    return std::span(branch_children_)
        .subspan(branch_child_first_[branch], branch_child_first_[branch + 1] - branch_child_first_[branch]);
  }
  // For each entry of rows() at a position above its branch: its index among the rows below the branch's
  // root; -1 for others.
  std::span<const int> carry_index() const { return carry_index_; }

  // Blocks of the factor, padding aside, diagonal blocks whole; of as many columns as were analysed.
  long block_count() const { return columns_.block_count(); }
  void count(MemoryCount& memory) const;  // of the analysis itself

  long factor_size() const { return factor_size_; }  // doubles of all panels
  long update_size() const { return update_size_; }  // doubles of the update stacks
  long carry_size() const { return carry_size_; }    // doubles of all carries
  // Sum of squared column counts, no padding.
  double factor_flops(int stage) const { return stage_flops_[stage]; }

 private:
  void find_supernodes(std::span<const int> stage_of_node, int stage_count);
  void list_rows();
  void find_branches();
  void list_branch_children();
  void list_carries();
  void place_storage();

  ColumnStructure columns_;
  std::vector<Supernode> supernodes_;
  std::vector<int> supernode_at_position_;
  std::vector<int> rows_, row_in_parent_;
  std::vector<Branch> branches_;
  std::vector<int> branch_child_first_, branch_children_, carry_index_;
  std::vector<int> child_first_, children_;
  std::vector<double> stage_flops_;
  long factor_size_ = 0, update_size_ = 0, carry_size_ = 0;
  std::vector<int> mark_;              // scratch
  std::vector<long> true_blocks_;      // scratch: blocks of a supernode that are not padding
  std::vector<double> subtree_flops_;  // scratch: by supernode, padding included
};

}  // namespace cleave
