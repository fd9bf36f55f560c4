// Moves nodes of a level graph (level_graph.h) between parts while that lowers the cut: what `fm` does to
// bodies, for nodes of several and much sooner, as whoever comes first moves first (after the greedy k-way
// refinement of Karypis and Kumar, "Multilevel k-way partitioning scheme for irregular graphs", Journal of
// Parallel and Distributed Computing 48, 1998, section 3.3).
//
// Nodes at the cut queue up, in their order. One that is due moves to the part B beside it of greatest
//
//     D_i(B) = sum of w_ij over j in B - sum of w_ij over the other j in its own part    (gains.h),
//
// ties to the part of fewer bodies, if that is positive, B stays within its bound and its own part keeps a
// node; its neighbours outside B then queue up again. Every move lowers the cut, so this ends. Who found no
// room when it was due does not wait for it.
#pragma once

#include <span>
#include <vector>

#include "partition/gains.h"
#include "partition/level_graph.h"

namespace cleave {

class LevelMoves {
 public:
  // most_bodies: of a part. One above it may shrink but not grow.
  LevelMoves(int parts, int most_bodies) : most_bodies_(most_bodies), bodies_(parts), gains_(parts) {}

  // part_of_node: (nodes).
  void run(const LevelGraph& graph, std::vector<int>& part_of_node);

 private:
  void queue_up(int node);
  void visit(const LevelGraph& graph, int node, std::vector<int>& part_of_node);
  int best_part(int node_bodies, std::span<const MoveGain> gains) const;

  int most_bodies_;
  std::vector<int> bodies_;  // by part
  std::vector<int> queue_;
  std::vector<char> waits_;  // by node
  PartGains gains_;
};

}  // namespace cleave
