#include "partition/cut_cover.h"

#include <algorithm>
#include <functional>

namespace cleave {
namespace {

// Of the edges for which is_cut(body, half-edge of it) holds, from both of their ends. uncovered: those of
// every body that no chosen body covers. Bodies are kept in buckets by that count, each a heap by index; a
// count only falls, so a stale body is put down where it belongs.
template <class IsCut>
std::vector<char> greedy_cover(const BodyGraph& graph, const IsCut& is_cut) {
  const int n = graph.body_count();
  std::vector<int> uncovered(n, 0);
  for (int i = 0; i < n; ++i)
    for (int k = graph.first(i); k < graph.last(i); ++k) uncovered[i] += is_cut(i, k);
  const int most = n == 0 ? 0 : std::ranges::max(uncovered);
  std::vector<std::vector<int>> bucket(most + 1);
  for (int i = 0; i < n; ++i) bucket[uncovered[i]].push_back(i);  // ascending: already heaps
  std::vector<char> chosen(n, 0);
  for (int count = most; count > 0; --count) {
    std::vector<int>& heap = bucket[count];
    while (!heap.empty()) {
      std::ranges::pop_heap(heap, std::greater<>());
      const int body = heap.back();
      heap.pop_back();
      if (uncovered[body] != count) {
        std::vector<int>& lower = bucket[uncovered[body]];
        lower.push_back(body);
        std::ranges::push_heap(lower, std::greater<>());
        continue;
      }
      chosen[body] = 1;
      uncovered[body] = 0;
      for (int k = graph.first(body); k < graph.last(body); ++k)
        if (is_cut(body, k) && uncovered[graph.neighbour(k)] > 0) --uncovered[graph.neighbour(k)];
    }
  }
  return chosen;
}

// A tree of parts; one level has a root above them.
class Tree {
 public:
  Tree(int part_count, std::span<const int> parent_of_part)
      : parent_(parent_of_part.begin(), parent_of_part.end()) {
    if (parent_.empty()) {
      parent_.assign(part_count, part_count);
      parent_.push_back(-1);
    }
    depth_.assign(parent_.size(), 0);
    for (int node = static_cast<int>(parent_.size()) - 2; node >= 0; --node)
      depth_[node] = depth_[parent_[node]] + 1;
  }

  int deepest() const { return depth_.empty() ? 0 : std::ranges::max(depth_); }
  int depth(int node) const { return depth_[node]; }
  int above(int node, int depth) const {
    while (depth_[node] > depth) node = parent_[node];
    return node;
  }
  int lowest_above(int a, int b) const {
    while (a != b) {
      int& lower = depth_[a] >= depth_[b] ? a : b;
      lower = parent_[lower];
    }
    return a;
  }

 private:
  std::vector<int> parent_, depth_;
};

}  // namespace

std::vector<char> cut_cover(const BodyGraph& graph, std::span<const int> part_of_body) {
  return greedy_cover(
      graph, [&](int body, int k) { return part_of_body[body] != part_of_body[graph.neighbour(k)]; });
}

// Nodes of one depth share neither bodies nor edges, so that they are covered together.
std::vector<int> separator_nodes(const BodyGraph& graph, std::span<const int> part_of_body, int part_count,
                                 std::span<const int> parent_of_part) {
  const Tree tree(part_count, parent_of_part);
  std::vector<int> node_of_body(part_of_body.begin(), part_of_body.end());
  std::vector<int> depth_of_cut(2 * static_cast<std::size_t>(graph.edge_count()), -1);
  for (int i = 0; i < graph.body_count(); ++i)
    for (int k = graph.first(i); k < graph.last(i); ++k)
      if (const int a = part_of_body[i], b = part_of_body[graph.neighbour(k)]; a != b)
        depth_of_cut[k] = tree.depth(tree.lowest_above(a, b));
  std::vector<char> is_above(graph.body_count(), 0);
  for (int depth = 0; depth < tree.deepest(); ++depth) {
    const std::vector<char> cover = greedy_cover(graph, [&](int body, int k) {
      return depth_of_cut[k] == depth && !is_above[body] && !is_above[graph.neighbour(k)];
    });
    for (int i = 0; i < graph.body_count(); ++i) {
      if (!cover[i]) continue;
      is_above[i] = 1;
      node_of_body[i] = tree.above(part_of_body[i], depth);
    }
  }
  return node_of_body;
}

}  // namespace cleave
