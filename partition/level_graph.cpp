#include "partition/level_graph.h"

#include <algorithm>
#include <numeric>

namespace cleave {

int LevelGraph::body_count() const { return std::accumulate(bodies.begin(), bodies.end(), 0); }

void LevelGraph::resize(int nodes, std::size_t half_edges) {
  bodies.resize(nodes);
  first.resize(nodes + 1);
  neighbour.resize(half_edges);
  weight.resize(half_edges);
}

void LevelGraph::take(const BodyGraph& graph, EdgeWeight unit) {
  const int n = graph.body_count();
  resize(n, 2 * static_cast<std::size_t>(graph.edge_count()));
  std::ranges::fill(bodies, 1);
  int divisor = 0, end = 0;
  for (int i = 0; i < n; ++i) {
    first[i] = end;
    for (int k = graph.first(i); k < graph.last(i); ++k, ++end) {
      neighbour[end] = graph.neighbour(k);
      weight[end] = graph.weight(k, unit);
      if (divisor == 0 || weight[end] % divisor != 0) divisor = std::gcd(divisor, weight[end]);
    }
  }
  first[n] = end;
  if (divisor <= 1) return;
  for (int& w : weight) w /= divisor;
}

void LevelGraph::split(std::span<const char> side, std::array<LevelGraph, 2>& halves,
                       std::array<std::vector<int>, 2>& nodes, std::vector<int>& place) const {
  place.resize(side.size());
  std::array<int, 2> count{};
  for (std::size_t node = 0; node < side.size(); ++node) place[node] = count[static_cast<int>(side[node])]++;
  for (int s = 0; s < 2; ++s) {
    nodes[s].resize(count[s]);
    halves[s].resize(count[s], neighbour.size());
  }
  std::array<int, 2> end{};
  for (int node = 0; node < node_count(); ++node) {
    const int own = side[node];
    LevelGraph& half = halves[own];
    nodes[own][place[node]] = node;
    half.bodies[place[node]] = bodies[node];
    half.first[place[node]] = end[own];
    for (int k = first[node]; k < first[node + 1]; ++k) {  // what is not kept is written over by the next
      half.neighbour[end[own]] = place[neighbour[k]];
      half.weight[end[own]] = weight[k];
      end[own] += side[neighbour[k]] == own;
    }
  }
  for (int s = 0; s < 2; ++s) {
    halves[s].first[count[s]] = end[s];
    halves[s].neighbour.resize(end[s]);
    halves[s].weight.resize(end[s]);
  }
}

int Coarsening::match(const LevelGraph& graph, int most_bodies, int begin, std::vector<int>& coarse_of_node) {
  const int n = graph.node_count();
  const auto degree = [&](int node) { return graph.first[node + 1] - graph.first[node]; };
  int most_degree = 0;
  for (int node = 0; node < n; ++node) most_degree = std::max(most_degree, degree(node));
  degree_first_.assign(most_degree + 2, 0);
  for (int node = 0; node < n; ++node) ++degree_first_[degree(node) + 1];
  std::partial_sum(degree_first_.begin(), degree_first_.end(), degree_first_.begin());
  order_.resize(n);
  for (int node = begin; node < n; ++node) order_[degree_first_[degree(node)]++] = node;
  for (int node = 0; node < begin; ++node) order_[degree_first_[degree(node)]++] = node;
  mate_.assign(n, -1);
  for (const int node : order_) {
    if (mate_[node] >= 0) continue;
    int best = -1, best_weight = 0;
    for (int k = graph.first[node]; k < graph.first[node + 1]; ++k) {
      const int other = graph.neighbour[k], weight = graph.weight[k];
      if (weight < best_weight || mate_[other] >= 0) continue;
      if (graph.bodies[node] + graph.bodies[other] > most_bodies) continue;
      const bool better = weight > best_weight || best < 0 || graph.bodies[other] < graph.bodies[best] ||
                          (graph.bodies[other] == graph.bodies[best] && other < best);
      if (better) best = other, best_weight = weight;
    }
    mate_[node] = best < 0 ? node : best;
    if (best >= 0) mate_[best] = node;
  }
  coarse_of_node.resize(n);
  int count = 0;
  for (int node = 0; node < n; ++node)
    coarse_of_node[node] = mate_[node] < node ? coarse_of_node[mate_[node]] : count++;
  return count;
}

void Coarsening::contract(const LevelGraph& graph, std::span<const int> coarse_of_node, int coarse_nodes,
                          LevelGraph& coarse) {
  lowest_.assign(coarse_nodes, -1);
  slot_.assign(coarse_nodes, -1);
  coarse.bodies.assign(coarse_nodes, 0);
  coarse.first.resize(coarse_nodes + 1);
  coarse.neighbour.resize(graph.neighbour.size());
  coarse.weight.resize(graph.neighbour.size());
  int end = 0;
  const auto add = [&](int node, int own, int from) {
    coarse.bodies[own] += graph.bodies[node];
    for (int k = graph.first[node]; k < graph.first[node + 1]; ++k) {
      const int other = coarse_of_node[graph.neighbour[k]];
      if (other == own) continue;
      if (slot_[other] < from) {
        slot_[other] = end;
        coarse.neighbour[end] = other;
        coarse.weight[end++] = graph.weight[k];
      } else {
        coarse.weight[slot_[other]] += graph.weight[k];
      }
    }
  };
  // A pair is met first at its lower node; the higher one is found among that one's neighbours.
  for (int node = 0; node < graph.node_count(); ++node) {
    const int own = coarse_of_node[node];
    if (lowest_[own] >= 0) continue;
    lowest_[own] = node;
    const int from = coarse.first[own] = end;
    add(node, own, from);
    for (const int other : graph.neighbours(node)) {
      if (other > node && coarse_of_node[other] == own) add(other, own, from);
    }
  }
  coarse.first[coarse_nodes] = end;
  coarse.neighbour.resize(end);
  coarse.weight.resize(end);
}

}  // namespace cleave
