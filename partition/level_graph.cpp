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
  // A pair is met first at its lower node.
  pair_.assign(coarse_nodes, {-1, -1});
  for (int node = 0; node < graph.node_count(); ++node) {
    std::array<int, 2>& pair = pair_[coarse_of_node[node]];
    pair[pair[0] >= 0] = node;
  }
  const std::size_t half_edges = graph.neighbour.size();
  coarse.resize(coarse_nodes, half_edges + 1);
  slot_.assign(coarse_nodes, -1);
  int end = 0;
  for (int own = 0; own < coarse_nodes; ++own) {
    const int from = coarse.first[own] = end;
    coarse.bodies[own] = 0;
    for (const int node : pair_[own]) {
      if (node < 0) continue;
      coarse.bodies[own] += graph.bodies[node];
      // Without branches, which nothing would predict: an edge within the pair is written behind all others.
      for (int k = graph.first[node]; k < graph.first[node + 1]; ++k) {
        const int other = coarse_of_node[graph.neighbour[k]];
        const bool inside = other == own, is_new = slot_[other] < from;
        const std::size_t place = inside ? half_edges : is_new ? end : slot_[other];
        coarse.neighbour[place] = other;
        coarse.weight[place] = (is_new ? 0 : coarse.weight[place]) + graph.weight[k];
        slot_[other] = is_new && !inside ? end : slot_[other];
        end += is_new && !inside;
      }
    }
  }
  coarse.first[coarse_nodes] = end;
  coarse.neighbour.resize(end);
  coarse.weight.resize(end);
}

}  // namespace cleave
