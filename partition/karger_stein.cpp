#include "partition/karger_stein.h"

#include <algorithm>
#include <cassert>
#include <numbers>
#include <utility>

namespace cleave {
namespace {

constexpr int kContractedAtOnce = 6;

// ceil(nodes / sqrt(2) + 1), by whole numbers: the quotient is not one.
int contracted_nodes(int nodes) {
  const long n = nodes;
  long quotient = static_cast<long>(nodes / std::numbers::sqrt2);
  while (2 * quotient * quotient < n * n) ++quotient;
  return static_cast<int>(quotient + 1);
}

// The edges between different nodes, one a pair.
std::vector<WeightedEdge> merged_edges(std::span<const WeightedEdge> edges,
                                       std::span<const int> node_of_body) {
  std::vector<WeightedEdge> merged;
  merged.reserve(edges.size());
  for (const WeightedEdge& edge : edges) {
    const auto [a, b] = std::minmax(node_of_body[edge.a], node_of_body[edge.b]);
    if (a != b) merged.push_back({a, b, edge.weight});
  }
  std::ranges::sort(merged, {}, [](const WeightedEdge& edge) { return std::pair(edge.a, edge.b); });
  std::size_t last = 0;
  for (std::size_t k = 1; k < merged.size(); ++k) {
    if (merged[k].a == merged[last].a && merged[k].b == merged[last].b)
      merged[last].weight += merged[k].weight;
    else
      merged[++last] = merged[k];
  }
  if (!merged.empty()) merged.resize(last + 1);
  return merged;
}

MinimumCut cut_between_two(std::span<const WeightedEdge> edges, std::vector<int> side_of_node) {
  MinimumCut cut{0, std::move(side_of_node)};
  for (const WeightedEdge& edge : edges)
    if (cut.side_of_node[edge.a] != cut.side_of_node[edge.b]) cut.weight += edge.weight;
  return cut;
}

}  // namespace

MinimumCut karger_stein(int nodes, std::span<const WeightedEdge> edges, Dice& dice) {
  assert(nodes >= 2);
  if (nodes <= kContractedAtOnce)
    return cut_between_two(edges, contract(nodes, edges, {2, nodes}, dice).node_of_body);
  MinimumCut best;
  for (const bool is_first : {true, false}) {
    const Contraction fewer = contract(nodes, edges, {contracted_nodes(nodes), nodes}, dice);
    const MinimumCut found = karger_stein(fewer.node_count, merged_edges(edges, fewer.node_of_body), dice);
    if (!is_first && found.weight >= best.weight) continue;
    best.weight = found.weight;
    best.side_of_node.clear();
    for (const int node : fewer.node_of_body) best.side_of_node.push_back(found.side_of_node[node]);
  }
  return best;
}

}  // namespace cleave
