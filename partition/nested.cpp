#include "partition/nested.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "harness/base/ceil_div.h"
#include "partition/leftovers.h"
#include "partition/refuse.h"
#include "partition/registry.h"

namespace cleave {
namespace {

// Measured on recorded and synthetic piles: more saves little and makes larger children (README.md).
constexpr double kJoinedGrowth = 0.2;

// A node of the tree as it is made: parents before children.
struct Node {
  int parent;
  bool is_leaf;
};

// A set that is still to be looked at. One that may not be split has no graph.
struct OpenSet {
  std::vector<int> bodies;  // of the whole graph, ascending
  BodyGraph graph;
  int parent;
  bool may_split;
};

// Depth first with a stack of its own: a set that loses one body at a time makes a deep tree.
class Recursion {
 public:
  Recursion(int max_bodies, int arity, const SplitSet& split_set)
      : max_bodies_(max_bodies), arity_(arity), split_set_(split_set) {}

  Partition run(const BodyGraph& graph) {
    const int n = graph.body_count();
    result_.part_of_body.resize(n);
    if (n == 0) return std::move(result_);
    std::vector<int> bodies(n);
    std::iota(bodies.begin(), bodies.end(), 0);
    take(graph, bodies, -1, n > max_bodies_);
    while (!open_.empty()) {
      const OpenSet set = std::move(open_.back());
      open_.pop_back();
      take(set.graph, set.bodies, set.parent, set.may_split);
    }
    number_nodes();
    return std::move(result_);
  }

 private:
  void take(const BodyGraph& graph, std::span<const int> bodies, int parent, bool may_split) {
    if (may_split) {
      const int most_bodies = ceil_div(graph.body_count(), arity_);
      const Partition parts = split_set_(graph, most_bodies);
      if (parts.part_count >= 2) {
        nodes_.push_back({parent, false});
        return open_children(graph, bodies, parts, most_bodies);
      }
    }
    nodes_.push_back({parent, true});
    for (const int body : bodies) result_.part_of_body[body] = result_.part_count;
    ++result_.part_count;
  }

  // Of the node that was made last, the first to be taken first.
  void open_children(const BodyGraph& graph, std::span<const int> bodies, const Partition& parts,
                     int most_bodies) {
    const int node = static_cast<int>(nodes_.size()) - 1;
    const std::vector<int> sizes = part_sizes(parts);
    std::vector<OpenSet> children(parts.part_count);
    std::vector<int> set_of_body = parts.part_of_body;
    for (int child = 0; child < parts.part_count; ++child) {
      children[child].parent = node;
      children[child].may_split = most_bodies > max_bodies_ && sizes[child] > max_bodies_;
      children[child].bodies.reserve(sizes[child]);
    }
    for (int k = 0; k < graph.body_count(); ++k) {
      OpenSet& child = children[parts.part_of_body[k]];
      child.bodies.push_back(bodies[k]);
      if (!child.may_split) set_of_body[k] = -1;
    }
    std::vector<BodyGraph> graphs = graph.induced(set_of_body, parts.part_count);
    for (int child = parts.part_count - 1; child >= 0; --child) {
      children[child].graph = std::move(graphs[child]);
      open_.push_back(std::move(children[child]));
    }
  }

  // Inner nodes backwards, as parents were made before their children.
  void number_nodes() {
    const int count = static_cast<int>(nodes_.size());
    std::vector<int> number(count);
    int leaf = 0, inner = count;
    for (int node = 0; node < count; ++node) number[node] = nodes_[node].is_leaf ? leaf++ : --inner;
    result_.parent_of_part.resize(count);
    for (int node = 0; node < count; ++node)
      result_.parent_of_part[number[node]] = nodes_[node].parent < 0 ? -1 : number[nodes_[node].parent];
  }

  const int max_bodies_, arity_;
  const SplitSet& split_set_;
  std::vector<Node> nodes_;
  std::vector<OpenSet> open_;
  Partition result_;
};

Algorithm with_max_bodies(const Algorithm& partitioner, int max_bodies) {
  std::map<std::string, std::string> values = partitioner.settings.values();
  values["max-bodies"] = std::to_string(max_bodies);
  return {partitioner.text, partitioner.name, Settings(std::move(values))};
}

}  // namespace

Partition split_by_recursion(const BodyGraph& graph, int max_bodies, int arity, const SplitSet& split_set) {
  if (max_bodies < 1) refuse("max_bodies", max_bodies, ">= 1");
  if (arity < 2) refuse("arity", arity, ">= 2");
  return Recursion(max_bodies, arity, split_set).run(graph);
}

SetSplitter::SetSplitter(const Algorithm& partitioner, const Algorithm& refiner, int arity)
    : partitioner_(partitioner),
      refiner_(make_refiner(refiner)),
      arity_(arity),
      max_bodies_(partitioner.settings.integer("max-bodies")) {}

Partition SetSplitter::grow(const BodyGraph& set, int most_bodies) const {
  const std::unique_ptr<Partitioner> partitioner =
      make_partitioner(with_max_bodies(partitioner_, most_bodies));
  Partition parts = partitioner->run(set);
  const PartsPromise& promise = partitioner->promised();
  if (!promise.at_most_max_bodies && !promise.at_most_grown_bodies) return parts;
  const int most_joined =
      most_bodies <= max_bodies_ ? max_bodies_ : most_grown_bodies(most_bodies, kJoinedGrowth);
  join_leftovers(set, {arity_, ceil_div(most_bodies, 2), most_joined}, parts);
  return parts;
}

Partition SetSplitter::run(const BodyGraph& graph) const {
  return split_by_recursion(graph, max_bodies_, arity_, [this](const BodyGraph& set, int most_bodies) {
    Partition parts = grow(set, most_bodies);
    refine(set, most_bodies, parts);
    return parts;
  });
}

void SetSplitter::refine(const BodyGraph& set, int most_bodies, Partition& parts) const {
  refiner_->run(set, most_bodies, parts);
}

}  // namespace cleave
