// H = M + J^T D J over a set of bodies, as a sparse matrix of 6x6 blocks with its Cholesky factor.
//
// The pattern (which bodies share a row) is analysed once; assembly then adds the 12x12 Gram matrix of every
// row group straight into the panels of the factor, at positions found by the analysis. Rows of a 3x3 block
// of D come along its basis (row_weights.h), so that their Gram matrix is one of scalar rows.
//
// Branches (block_symbolic.h) let pieces of H be assembled and factored by different threads: assembly in any
// order, factorisation of a branch after those below it. A group between bodies of two branches is assembled
// with the one that is eliminated first and leaves its diagonal block of the other, to be added when that is
// factored.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/block_cholesky.h"
#include "solver/prepared_step.h"
#include "solver/row_weights.h"

namespace cleave {

class BlockMatrix {
 public:
  // bodies: the unknowns, by index in the problem; local_of_body[body] = place in `bodies`. groups: indices
  // into step.groups() with every dynamic body in `bodies`. step must outlive the matrix. False where the
  // factor has more than most_blocks (block_symbolic.h); its pattern is then unknown.
  bool analyze(const PreparedStep& step, std::span<const int> bodies, std::span<const int> local_of_body,
               std::span<const int> groups, std::span<const int> stage_of_local = {}, int stage_count = 1,
               long most_blocks = BlockSymbolic::kAnyBlocks);

  // For the same bodies, stages and local_of_body, other groups: keeps the analysis where every pair is in
  // its pattern; false, and nothing is changed, where one is not.
  bool rebind(const PreparedStep& step, std::span<const int> local_of_body, std::span<const int> groups);

  // The same with every body and group of a step, by their indices.
  bool analyze_whole(const PreparedStep& step, std::span<const int> stage_of_body, int stage_count,
                     long most_blocks);
  bool rebind_whole(const PreparedStep& step);

  // What matrix and factor take, once analysed; of one whose analysis ended early, what its blocks take,
  // which is less.
  void count(MemoryCount& memory) const;
  // After analysis and rebind: assembly and factorisation want it.
  void allocate();
  // Blocks of a factor that takes no more than this.
  static long most_blocks(std::uint64_t limit_bytes);

  // rows: of the whole problem, with their D.
  void assemble(const WeightedRows& rows, int branch);
  // Which one assembles it, of a whole step.
  int branch_of_group(int group) const { return group_branch_[group]; }
  // After assembly of this branch and factorisation of the child branches. False when a pivot is not
  // positive.
  bool factor(int branch);
  // The same of a branch that is one supernode, in pieces; this one begins a strip of columns of its panel,
  // the others are those of cholesky().
  void gather(int branch, int column_strip);
  // Of all branches.
  void assemble(const WeightedRows& rows);
  bool factor();
  int branch_count() const { return static_cast<int>(cholesky_.symbolic().branches().size()); }
  // Of a whole step: the bodies that are eliminated in a branch.
  std::span<const int> bodies_of(int branch) const {
    return std::span(branch_locals_)
        .subspan(branch_local_first_[branch], branch_local_first_[branch + 1] - branch_local_first_[branch]);
  }

  BlockCholesky& cholesky() { return cholesky_; }
  const BlockCholesky& cholesky() const { return cholesky_; }

 private:
  // A group of rows. Where its blocks belong is looked up in the first assembly of its branch.
  struct Entry {
    struct Body {
      int local = -1;  // -1: static
      bool is_late = false;
      BlockCholesky::Place place;
    };
    bool has_b() const { return b.local >= 0; }

    int group = 0;
    Body a, b;
    BlockCholesky::Place ab;
    int late = -1;  // slot of the diagonal block kept for another branch, -1 for none
  };

  void number(const PreparedStep& step);
  void list_edges(const PreparedStep& step, std::span<const int> local_of_body, std::span<const int> groups);
  void place_bodies();
  void sort_groups(const PreparedStep& step, std::span<const int> local_of_body, std::span<const int> groups);
  void list_entries(const PreparedStep& step, std::span<const int> local_of_body,
                    std::span<const int> groups);
  void place_entries(int branch);
  void add_entry(const Entry& entry, const WeightedRows& rows);
  void add_late(int slot);

  const PreparedStep* step_ = nullptr;
  BlockCholesky cholesky_;
  bool analyzed_ = false;
  std::vector<int> bodies_;
  std::vector<int> local_branch_, branch_local_first_, branch_locals_;  // places in bodies_ by branch
  std::vector<int> identity_;                      // 0, 1, ...: at least as many as bodies and as groups
  std::vector<Entry> entries_;                     // sorted by branch of assembly
  std::vector<int> entry_first_;                   // (branches + 1)
  std::vector<char> is_placed_;                    // by branch
  std::vector<BlockCholesky::Place> late_places_;  // of the slots
  std::vector<int> late_branch_, late_first_, late_slots_;  // slots by the branch that they are kept for
  std::vector<int> group_branch_;    // branch of assembly, in the order in which the groups were given
  std::vector<int> group_order_;     // scratch: their places by branch
  std::vector<double> late_blocks_;  // (slots, 6, 6)
  std::vector<char> late_any_;
  std::vector<std::pair<int, int>> edges_;
};

}  // namespace cleave
