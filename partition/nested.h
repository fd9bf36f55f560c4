// Splits bodies by recursion (Karypis & Kumar, SIAM Journal on Scientific Computing 20, 1998, section 2.1): a
// set of more than max_bodies bodies is split into about `arity` children, each of which is split again. What
// splits one set is any partitioner that has a parameter max-bodies, then any refiner. A set that it leaves
// whole is a leaf.
//
// The nodes of the tree are the sets: the leaves 0..parts-1, which are the parts, in order of creation (depth
// first, children in the order of their parts), then the inner nodes. Every parent has a greater number than
// its children, so that the last node is the root. A single part is its own root; no bodies have no node.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "harness/base/algorithm.h"
#include "partition/body_graph.h"
#include "partition/partition.h"
#include "partition/partitioner.h"
#include "partition/refiner.h"

namespace cleave {

// Splits one set of at least two bodies. most_bodies: of a child, ceil(bodies of the set / arity), which what
// refines may exceed by its growth.
using SplitSet = std::function<Partition(const BodyGraph& set, int most_bodies)>;

// Leaves have at most max_bodies bodies, and those of a set whose children were to have so many (most_bodies
// <= max_bodies), or that split_set left whole, as many as split_set left them. max_bodies >= 1, arity >= 2.
Partition split_by_recursion(const BodyGraph& graph, int max_bodies, int arity, const SplitSet& split_set);

// What splits the sets: a partitioner and a refiner of the tables.
class SetSplitter {
 public:
  // partitioner: one that has a parameter max-bodies. arity >= 2.
  SetSplitter(const Algorithm& partitioner, const Algorithm& refiner, int arity);

  // By recursion, every set refined.
  Partition run(const BodyGraph& graph) const;

  int max_bodies() const { return max_bodies_; }
  int arity() const { return arity_; }

  // Runs the partitioner with max-bodies = most_bodies. Where its row promises a bound, what is left over
  // (leftovers.h) is joined: parts of less than half of that, to at most 1.2 times that, or to max_bodies
  // where children are to be leaves.
  Partition grow(const BodyGraph& set, int most_bodies) const;
  void refine(const BodyGraph& set, int most_bodies, Partition& parts) const;

 private:
  Algorithm partitioner_;
  std::unique_ptr<Refiner> refiner_;
  int arity_;
  int max_bodies_;
};

}  // namespace cleave
