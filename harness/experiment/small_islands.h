// --skip-small-islands: the bodies of islands larger than max_bodies are split as if the small islands were
// not there; then every small island becomes one part, in order of its lowest body.
#pragma once

#include <vector>

#include "partition/body_graph.h"
#include "partition/partition.h"
#include "partition/partitioner.h"

namespace cleave {

class SmallIslands {
 public:
  // Small are those of at most max_bodies bodies.
  SmallIslands(const BodyGraph& graph, int max_bodies);

  // Of the bodies in large islands alone.
  const BodyGraph& large() const { return large_; }

  // Parts of `large` with the small islands after them, in one level.
  Partition with_small(const Partition& large) const;
  // The same in a tree, the small islands as further children of the root.
  Partition with_small_in_tree(const Partition& large) const;

 private:
  BodyGraph large_;
  std::vector<int> small_of_body_;  // (n): number of the small island, -1 in a large one
  int small_count_ = 0;
};

Partition partition_large_islands(const BodyGraph& graph, const Partitioner& partitioner, int max_bodies);

}  // namespace cleave
