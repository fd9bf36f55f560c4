#include "partition/gains.h"

#include <algorithm>
#include <utility>

namespace cleave {

std::span<const MoveGain> MoveGains::of(int body, std::span<const int> part_of_body) {
  return gains_.of(
      part_of_body[body], graph_.first(body), graph_.last(body),
      [&](int k) { return part_of_body[graph_.neighbour(k)]; },
      [&](int k) { return graph_.weight(k, unit_); });
}

int edge_weight(const BodyGraph& graph, int a, int b, EdgeWeight unit) {
  if (graph.degree(a) > graph.degree(b)) std::swap(a, b);
  const std::span<const int> neighbours = graph.neighbours(a);
  const auto found = std::lower_bound(neighbours.begin(), neighbours.end(), b);
  if (found == neighbours.end() || *found != b) return 0;
  return graph.weight(graph.first(a) + static_cast<int>(found - neighbours.begin()), unit);
}

void ExchangeHeap::push(const Exchange& exchange) {
  entries_.push_back(exchange);
  std::push_heap(entries_.begin(), entries_.end());
}

Exchange ExchangeHeap::pop() {
  std::pop_heap(entries_.begin(), entries_.end());
  const Exchange best = entries_.back();
  entries_.pop_back();
  return best;
}

}  // namespace cleave
