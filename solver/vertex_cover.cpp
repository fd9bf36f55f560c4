#include "solver/vertex_cover.h"

#include <algorithm>
#include <set>

namespace cleave {
namespace {

class CoverSearch {
 public:
  CoverSearch(int node_count, std::span<const std::pair<int, int>> edges)
      : neighbours_(node_count),
        colour_(node_count, -1),
        partner_(node_count, -1),
        depth_(node_count, -1),
        next_(node_count, 0),
        uncovered_(node_count, 0),
        reached_(node_count, 0),
        cover_(node_count, 0) {
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

  // Hopcroft and Karp 1973: rounds of augmenting paths that are shortest to begin with, O(edges sqrt(nodes)).
  // The cover does not depend on which maximum matching is found.
  void match() {
    while (find_depths()) {
      for (int left : component_)
        if (colour_[left] == 0 && partner_[left] == -1) augment(left);
    }
  }

  // Depth of every left node along alternating paths from the free ones; false when no path ends at a free
  // right node.
  bool find_depths() {
    bool free_right = false;
    queue_.clear();
    for (int left : component_) {
      if (colour_[left] != 0) continue;
      next_[left] = 0;
      depth_[left] = partner_[left] == -1 ? 0 : -1;
      if (partner_[left] == -1) queue_.push_back(left);
    }
    for (std::size_t k = 0; k < queue_.size(); ++k) {
      for (int right : neighbours_[queue_[k]]) {
        const int taken_by = partner_[right];
        free_right |= taken_by == -1;
        if (taken_by == -1 || depth_[taken_by] != -1) continue;
        depth_[taken_by] = depth_[queue_[k]] + 1;
        queue_.push_back(taken_by);
      }
    }
    return free_right;
  }

  // Grows the matching along an alternating path of rising depth from a free left node, if there is one left.
  // A path may be as long as the component, so it is kept here and not on the stack.
  void augment(int free_left) {
    path_.assign(1, free_left);
    while (!path_.empty()) {
      const int left = path_.back();
      if (next_[left] == neighbours_[left].size()) {
        path_.pop_back();
        continue;
      }
      const int right = neighbours_[left][next_[left]++];
      if (partner_[right] == -1) return flip_path();
      if (depth_[partner_[right]] == depth_[left] + 1) path_.push_back(partner_[right]);
    }
  }

  // Every left node of the path takes the right node that was tried last.
  void flip_path() {
    for (int left : path_) {
      partner_[left] = neighbours_[left][next_[left] - 1];
      partner_[partner_[left]] = left;
    }
  }

  // Marks what alternating paths from free left nodes reach.
  void mark_reached() {
    queue_.clear();
    for (int left : component_)
      if (colour_[left] == 0 && partner_[left] == -1) queue_.push_back(left), reached_[left] = 1;
    for (std::size_t k = 0; k < queue_.size(); ++k) {
      for (int right : neighbours_[queue_[k]]) {
        reached_[right] = 1;
        const int taken_by = partner_[right];
        if (taken_by == -1 || reached_[taken_by]) continue;
        reached_[taken_by] = 1;
        queue_.push_back(taken_by);
      }
    }
  }

  void cover_bipartite() {
    match();
    mark_reached();
    for (int node : component_) cover_[node] = (colour_[node] == 0) != (reached_[node] != 0);
  }

  void cover_greedily() {
    std::sort(component_.begin(), component_.end());
    std::set<std::pair<int, int>> queue;  // (-uncovered edges, node)
    for (int node : component_) {
      uncovered_[node] = static_cast<int>(neighbours_[node].size());
      queue.emplace(-uncovered_[node], node);
    }
    while (!queue.empty() && queue.begin()->first < 0) {
      const int node = queue.begin()->second;
      queue.erase(queue.begin());
      cover_[node] = 1;
      for (int other : neighbours_[node]) {
        if (cover_[other]) continue;
        queue.erase({-uncovered_[other], other});
        queue.emplace(-(--uncovered_[other]), other);
      }
    }
  }

  std::vector<std::vector<int>> neighbours_;
  std::vector<int> colour_, partner_, component_;
  std::vector<int> depth_;         // of left nodes
  std::vector<std::size_t> next_;  // of left nodes: place of the neighbour to be tried next
  std::vector<int> uncovered_;     // edges
  std::vector<char> reached_, cover_;
  std::vector<int> queue_, path_;  // scratch
};

}  // namespace

std::vector<char> vertex_cover(int node_count, std::span<const std::pair<int, int>> edges) {
  return CoverSearch(node_count, edges).run();
}

}  // namespace cleave
