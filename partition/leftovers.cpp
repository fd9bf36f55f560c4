#include "partition/leftovers.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace cleave {
namespace {

class Joining {
 public:
  Joining(const BodyGraph& graph, const LeftoverBounds& bounds, const Partition& partition)
      : bounds_(bounds),
        parts_(partition.part_count),
        size_(part_sizes(partition)),
        joined_with_(partition.part_count),
        weight_(partition.part_count) {
    std::iota(joined_with_.begin(), joined_with_.end(), 0);
    for (int part = 0; part < parts_; ++part) enqueue(part);
    for (int body = 0; body < graph.body_count(); ++body) {
      const int part = partition.part_of_body[body];
      for (int k = graph.first(body); k < graph.last(body); ++k) {
        const int other = partition.part_of_body[graph.neighbour(k)];
        if (other != part) weight_[part][other] += graph.weight(k, EdgeWeight::rows);
      }
    }
  }

  void run() {
    while (parts_ > bounds_.parts && !small_.empty()) {
      const int part = small_.begin()->second;
      small_.erase(small_.begin());
      // Who fits with none now never will: others only grow.
      if (const int other = best_for(part); other >= 0) join(std::min(part, other), std::max(part, other));
    }
  }

  void close_up(Partition& partition) const {
    std::vector<int> id(joined_with_.size());
    int next = 0;
    for (std::size_t part = 0; part < id.size(); ++part) {
      const std::size_t into = joined_with_[part];  // a lower one, whose id is known
      id[part] = into == part ? next++ : id[into];
    }
    for (int& part : partition.part_of_body) part = id[part];
    partition.part_count = next;
  }

 private:
  void enqueue(int part) {
    if (size_[part] < bounds_.small_bodies) small_.insert({size_[part], part});
  }

  int best_for(int part) const {
    int best = -1;
    long most = 0;
    for (const auto& [other, weight] : weight_[part]) {
      if (weight <= most || size_[other] > bounds_.most_bodies - size_[part]) continue;
      best = other;
      most = weight;
    }
    return best;
  }

  void join(int part, int other) {
    small_.erase({size_[part], part});
    small_.erase({size_[other], other});
    size_[part] += size_[other];
    joined_with_[other] = part;
    --parts_;
    enqueue(part);
    for (const auto& [third, weight] : weight_[other]) {
      weight_[third].erase(other);
      if (third == part) continue;
      weight_[part][third] += weight;
      weight_[third][part] += weight;
    }
    weight_[other].clear();
  }

  const LeftoverBounds bounds_;
  int parts_;
  std::vector<int> size_;                    // (parts as given) bodies
  std::vector<int> joined_with_;             // a part of lower id, or itself
  std::vector<std::map<int, long>> weight_;  // of the edges to each adjacent part
  std::set<std::pair<int, int>> small_;      // (bodies, part)
};

}  // namespace

void join_leftovers(const BodyGraph& graph, const LeftoverBounds& bounds, Partition& partition) {
  if (partition.part_count <= bounds.parts) return;
  Joining joining(graph, bounds, partition);
  joining.run();
  joining.close_up(partition);
}

}  // namespace cleave
