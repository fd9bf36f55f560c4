// Bodies that stand between parts: the interface in body space, at every level of a tree of parts.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/memory_count.h"
#include "solver/parts.h"
#include "solver/prepared_step.h"

namespace cleave {

// The node of the tree that each body is eliminated with. An edge is cut at the lowest node that has both of
// its parts below it. From the root down, a vertex cover (vertex_cover.h) of the edges cut at a node that no
// cover above touches belongs to that node; all other bodies belong to their part. Without the covers parts
// share no row, so that nodes are subtrees of the elimination tree, and their numbers, children first, an
// order of elimination: George's nested dissection (1973) with the tree that it is given.
class Separators {
 public:
  // Parts of one level have one node above them.
  void find(const PreparedStep& step, const Parts& parts);

  std::span<const int> node_of_body() const { return node_of_body_; }
  int node_count() const { return node_count_; }
  int part_count() const { return part_count_; }  // nodes 0 .. part_count() - 1
  void count(MemoryCount& memory) const {
    memory.add_grown(node_of_body_, parent_, depth_, edges_, node_of_edge_, edge_first_, edge_order_,
                     local_edges_, local_of_body_, bodies_);
  }

 private:
  void read_tree(const Parts& parts);
  int node_above(int a, int b) const;
  void sort_edges(const PreparedStep& step, std::span<const int> part_of_body);
  void cover(int node);

  int part_count_ = 0, node_count_ = 0;
  std::vector<int> node_of_body_;
  std::vector<int> parent_, depth_;                          // by node; the root is its own parent
  std::vector<std::pair<int, int>> edges_;                   // that are cut
  std::vector<int> node_of_edge_, edge_first_, edge_order_;  // by the node that cuts them
  std::vector<std::pair<int, int>> local_edges_;             // scratch
  std::vector<int> local_of_body_, bodies_;                  // scratch
};

}  // namespace cleave
