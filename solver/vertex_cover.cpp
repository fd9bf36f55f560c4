#include "solver/vertex_cover.h"

#include <algorithm>
#include <set>

namespace cleave {
namespace {

class CoverSearch {
 public:
  CoverSearch(int node_count, std::span<const std::pair<int, int>> edges)
      : neighbours_(node_count), colour_(node_count, -1), partner_(node_count, -1), cover_(node_count, 0) {
    for (auto [a, b] : edges) neighbours_[a].push_back(b), neighbours_[b].push_back(a);
    for (std::vector<int>& list : neighbours_) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
  }

  std::vector<char> run() {
    for (int node = 0; node < static_cast<int>(neighbours_.size()); ++node) {
      if (colour_[node] != -1 || neighbours_[node].empty()) continue;
      const bool bipartite = colour_component(node);
      if (bipartite) {
        cover_bipartite();
      } else {
        cover_greedily();
      }
    }
    return cover_;
  }

 private:
  // Breadth-first two-colouring; false when an edge joins equal colours.
  bool colour_component(int start) {
    bool bipartite = true;
    component_.assign(1, start);
    colour_[start] = 0;
    for (std::size_t k = 0; k < component_.size(); ++k) {
      for (int other : neighbours_[component_[k]]) {
        if (colour_[other] == -1) {
          colour_[other] = 1 - colour_[component_[k]];
          component_.push_back(other);
        } else if (colour_[other] == colour_[component_[k]]) {
          bipartite = false;
        }
      }
    }
    return bipartite;
  }

  // Grows the matching along an alternating path from a left node, if there is one.
  bool augment(int left) {
    for (int right : neighbours_[left]) {
      if (visited_.insert(right).second && (partner_[right] == -1 || augment(partner_[right]))) {
        partner_[left] = right;
        partner_[right] = left;
        return true;
      }
    }
    return false;
  }

  void reach(int left) {
    if (!visited_.insert(left).second) return;
    for (int right : neighbours_[left]) {
      if (visited_.insert(right).second && partner_[right] != -1) reach(partner_[right]);
    }
  }

  void cover_bipartite() {
    for (int node : component_) {
      visited_.clear();
      if (colour_[node] == 0) augment(node);
    }
    visited_.clear();
    for (int node : component_) {
      if (colour_[node] == 0 && partner_[node] == -1) reach(node);
    }
    for (int node : component_) cover_[node] = (colour_[node] == 0) != visited_.contains(node);
  }

  void cover_greedily() {
    const auto uncovered = [&](int node) {
      return std::ranges::count_if(neighbours_[node], [&](int other) { return !cover_[other]; });
    };
    std::sort(component_.begin(), component_.end());
    std::set<std::pair<long, int>> queue;  // (-uncovered edges, node)
    std::vector<long> count(neighbours_.size(), 0);
    for (int node : component_) queue.emplace(-(count[node] = uncovered(node)), node);
    while (queue.begin()->first < 0) {
      const int node = queue.begin()->second;
      queue.erase(queue.begin());
      cover_[node] = 1;
      for (int other : neighbours_[node]) {
        if (cover_[other]) continue;
        queue.erase({-count[other], other});
        queue.emplace(-(--count[other]), other);
      }
      if (queue.empty()) break;
    }
  }

  std::vector<std::vector<int>> neighbours_;
  std::vector<int> colour_, partner_, component_;
  std::vector<char> cover_;
  std::set<int> visited_;
};

}  // namespace

std::vector<char> vertex_cover(int node_count, std::span<const std::pair<int, int>> edges) {
  return CoverSearch(node_count, edges).run();
}

}  // namespace cleave
