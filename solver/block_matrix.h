// H = M + J^T D J over a set of bodies, as a sparse matrix of 6x6 blocks with its Cholesky factor.
//
// The pattern (which bodies share a row) is analysed once; assembly then adds the 12x12 Gram matrix of every
// row group straight into the panels of the factor, at positions found by the analysis. Rows of a 3x3 block
// of D come along its basis (row_weights.h), so that their Gram matrix is one of scalar rows.
//
// Stages (see block_symbolic.h) let parts of H be assembled and factored by different threads. A group
// between a body of an early stage and one of the last stage leaves its block of the last stage to be added
// when that is assembled.
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
  // into step.groups() with every dynamic body in `bodies`. step must outlive the matrix.
  void analyze(const PreparedStep& step, std::span<const int> bodies, std::span<const int> local_of_body,
               std::span<const int> groups, std::span<const int> stage_of_local = {}, int stage_count = 1);

  // For the same bodies, stages and local_of_body, other groups: keeps the analysis where every pair is in
  // its pattern; false, and nothing is changed, where one is not.
  bool rebind(const PreparedStep& step, std::span<const int> local_of_body, std::span<const int> groups);

  // The same with every body and group of a step, by their indices.
  void analyze_whole(const PreparedStep& step, std::span<const int> stage_of_body = {}, int stage_count = 1);
  bool rebind_whole(const PreparedStep& step);

  // rows: of the whole problem, with their D. The last stage comes after the others.
  void assemble(const WeightedRows& rows, int stage);
  bool factor(int stage) { return cholesky_.factor(stage); }

  BlockCholesky& cholesky() { return cholesky_; }
  const BlockCholesky& cholesky() const { return cholesky_; }

 private:
  struct Entry {
    int group = 0;
    int stage_a = 0, stage_b = -1;  // -1: static
    BlockCholesky::Place a, b, ab;
    int late = -1;  // slot of the Gram matrix kept for the last stage, -1 for none
  };

  void number(const PreparedStep& step);
  void sort_by_stage(std::span<const int> stage_of_item, std::vector<int>& first,
                     std::vector<int>& items) const;
  void list_edges(const PreparedStep& step, std::span<const int> local_of_body, std::span<const int> groups);
  void place_groups(const PreparedStep& step, std::span<const int> local_of_body,
                    std::span<const int> groups);

  const PreparedStep* step_ = nullptr;
  BlockCholesky cholesky_;
  std::vector<int> bodies_, stage_of_local_;
  std::vector<int> stage_local_first_, stage_locals_;  // places in bodies_ by stage
  std::vector<int> identity_;                          // 0, 1, ...: at least as many as bodies and as groups
  std::vector<Entry> entries_;                         // sorted by stage of assembly
  std::vector<int> entry_first_;                       // (stages + 1)
  std::vector<int> late_entries_;
  std::vector<int> group_stage_, group_order_;  // scratch: stage of assembly of the groups, and by it
  std::vector<double> late_gram_;               // (late entries, 12, 12)
  std::vector<char> late_any_;
  std::vector<std::pair<int, int>> edges_;
};

}  // namespace cleave
