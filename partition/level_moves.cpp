#include "partition/level_moves.h"

#include <algorithm>

namespace cleave {

void LevelMoves::queue_up(int node) {
  if (waits_[node] != 0) return;
  waits_[node] = 1;
  queue_.push_back(node);
}

// -1 for none.
int LevelMoves::best_part(int node_bodies, std::span<const MoveGain> gains) const {
  int best = -1, best_gain = 0;
  for (const auto& [part, gain] : gains) {
    if (bodies_[part] + node_bodies > most_bodies_) continue;
    const bool is_fewer = best >= 0 && bodies_[part] < bodies_[best];
    if (gain > best_gain || (gain == best_gain && is_fewer)) best = part, best_gain = gain;
  }
  return best;
}

void LevelMoves::visit(const LevelGraph& graph, int node, std::vector<int>& part_of_node) {
  waits_[node] = 0;
  const int own = part_of_node[node], node_bodies = graph.bodies[node];
  if (bodies_[own] == node_bodies) return;
  const std::span<const MoveGain> gains = gains_.of(
      own, graph.first[node], graph.first[node + 1], [&](int k) { return part_of_node[graph.neighbour[k]]; },
      [&](int k) { return graph.weight[k]; });
  const int best = best_part(node_bodies, gains);
  if (best < 0) return;
  bodies_[own] -= node_bodies;
  bodies_[best] += node_bodies;
  part_of_node[node] = best;
  for (const int other : graph.neighbours(node))
    if (part_of_node[other] != best) queue_up(other);
}

void LevelMoves::run(const LevelGraph& graph, std::vector<int>& part_of_node) {
  std::ranges::fill(bodies_, 0);
  waits_.assign(graph.node_count(), 0);
  queue_.clear();
  for (int node = 0; node < graph.node_count(); ++node) {
    const int own = part_of_node[node];
    bodies_[own] += graph.bodies[node];
    const auto is_cut = [&](int other) { return part_of_node[other] != own; };
    if (std::ranges::any_of(graph.neighbours(node), is_cut)) queue_up(node);
  }
  for (std::size_t k = 0; k < queue_.size(); ++k) visit(graph, queue_[k], part_of_node);
}

}  // namespace cleave
