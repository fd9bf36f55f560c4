#include "partition/contraction.h"

#include <bit>
#include <numeric>
#include <utility>

#include "partition/partition.h"

namespace cleave {
namespace {

// Fenwick tree of the weights of the edges that were not drawn.
class EdgeDraws {
 public:
  explicit EdgeDraws(std::span<const WeightedEdge> edges) : edges_(edges), sum_(edges.size() + 1, 0) {
    for (std::size_t place = 1; place < sum_.size(); ++place) {
      sum_[place] += edges[place - 1].weight;
      left_ += edges[place - 1].weight;
      const std::size_t above = place + (place & (0 - place));
      if (above < sum_.size()) sum_[above] += sum_[place];
    }
  }

  bool empty() const { return left_ == 0; }

  const WeightedEdge& draw(Dice& dice) {
    const WeightedEdge& edge = edges_[find(static_cast<int>(dice.below(left_)))];
    remove(&edge - edges_.data() + 1, edge.weight);
    return edge;
  }

 private:
  // The first edge at which the partial sums exceed the number.
  std::size_t find(int number) const {
    std::size_t place = 0;
    for (std::size_t step = std::bit_floor(sum_.size() - 1); step > 0; step /= 2) {
      if (place + step >= sum_.size() || sum_[place + step] > number) continue;
      place += step;
      number -= sum_[place];
    }
    return place;
  }

  void remove(std::size_t place, int weight) {
    left_ -= weight;
    for (; place < sum_.size(); place += place & (0 - place)) sum_[place] -= weight;
  }

  std::span<const WeightedEdge> edges_;
  std::vector<int> sum_;  // (edges + 1): of the edges [i - (i & -i), i), from 1
  int left_ = 0;
};

// Disjoint sets (Tarjan 1975): union by size, paths halved.
class Nodes {
 public:
  explicit Nodes(int bodies) : parent_(bodies), size_(bodies, 1) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int find(int body) {
    while (parent_[body] != body) body = parent_[body] = parent_[parent_[body]];
    return body;
  }
  int size(int root) const { return size_[root]; }
  void join(int root, int other) {
    if (size_[root] < size_[other]) std::swap(root, other);
    parent_[other] = root;
    size_[root] += size_[other];
  }

 private:
  std::vector<int> parent_, size_;
};

}  // namespace

std::vector<WeightedEdge> edges_of(const BodyGraph& graph, EdgeWeight unit) {
  std::vector<WeightedEdge> edges;
  edges.reserve(graph.edge_count());
  for (int body = 0; body < graph.body_count(); ++body)
    for (int k = graph.first(body); k < graph.last(body); ++k)
      if (graph.neighbour(k) > body) edges.push_back({body, graph.neighbour(k), graph.weight(k, unit)});
  return edges;
}

Contraction contract(int bodies, std::span<const WeightedEdge> edges, const ContractionGoal& goal,
                     Dice& dice) {
  Nodes nodes(bodies);
  EdgeDraws draws(edges);
  Contraction contraction;
  for (int left = bodies; left > goal.nodes && !draws.empty();) {
    const WeightedEdge& edge = draws.draw(dice);
    const int a = nodes.find(edge.a), b = nodes.find(edge.b);
    if (a == b) continue;
    if (nodes.size(a) > goal.most_bodies - nodes.size(b)) {
      ++contraction.refused;
      continue;
    }
    nodes.join(a, b);
    --left;
  }
  std::vector<int> root_of_body(bodies);
  for (int body = 0; body < bodies; ++body) root_of_body[body] = nodes.find(body);
  Partition numbered = numbered_by_lowest_body(root_of_body);
  contraction.node_of_body = std::move(numbered.part_of_body);
  contraction.node_count = numbered.part_count;
  return contraction;
}

}  // namespace cleave
