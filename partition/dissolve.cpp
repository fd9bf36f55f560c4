#include "partition/dissolve.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "partition/gains.h"
#include "partition/repair.h"

namespace cleave {
namespace {

class Dissolving {
 public:
  Dissolving(const BodyGraph& graph, int most_bodies, Partition& partition)
      : graph_(graph),
        most_bodies_(most_bodies),
        part_of_body_(partition.part_of_body),
        gains_(graph, EdgeWeight::rows, partition.part_count),
        members_(partition.part_count) {
    for (int body = 0; body < graph.body_count(); ++body) members_[part_of_body_[body]].push_back(body);
    for (int part = 0; part < partition.part_count; ++part) by_size_.insert({bodies_in(part), part});
  }

  long run(int parts) {
    while (static_cast<int>(by_size_.size()) > parts) {
      const int part = by_size_.begin()->second;
      by_size_.erase(by_size_.begin());
      take_apart(part);
    }
    return gains_counted_;
  }

 private:
  int bodies_in(int part) const { return static_cast<int>(members_[part].size()); }

  void take_apart(int part) {
    std::vector<int> bodies = std::move(members_[part]);
    std::ranges::sort(bodies);
    moves_.clear();
    for (const int body : bodies) push_moves(body);
    auto lowest = bodies.begin();
    for (std::size_t left = bodies.size(); left > 0; --left) {
      if (const std::optional<Exchange> move = find(part)) {
        place(part, move->first, move->second);
        continue;
      }
      while (part_of_body_[*lowest] != part) ++lowest;
      place(part, *lowest, by_size_.begin()->second);
    }
  }

  void push_moves(int body) {
    for (const MoveGain& move : gains_.of(body, part_of_body_)) {
      ++gains_counted_;
      if (bodies_in(move.part) < most_bodies_) moves_.push({move.gain, body, move.part});
    }
  }

  // While this part is taken apart its bodies' gains only rise, so that the heap has what is true before what
  // is stale; and a part that is full stays so.
  std::optional<Exchange> find(int part) {
    while (!moves_.empty()) {
      const Exchange move = moves_.pop();
      if (part_of_body_[move.first] == part && bodies_in(move.second) < most_bodies_) return move;
    }
    return std::nullopt;
  }

  void place(int part, int body, int into) {
    by_size_.erase({bodies_in(into), into});
    members_[into].push_back(body);
    by_size_.insert({bodies_in(into), into});
    part_of_body_[body] = into;
    for (const int other : graph_.neighbours(body))
      if (part_of_body_[other] == part) push_moves(other);
  }

  const BodyGraph& graph_;
  const int most_bodies_;
  std::vector<int>& part_of_body_;
  MoveGains gains_;
  std::vector<std::vector<int>> members_;  // (parts)
  std::set<std::pair<int, int>> by_size_;  // (bodies, part)
  ExchangeHeap moves_;                     // of the bodies of the part at hand
  long gains_counted_ = 0;
};

}  // namespace

long dissolve_smallest(const BodyGraph& graph, int parts, int most_bodies, Partition& partition) {
  assert(static_cast<long>(parts) * most_bodies >= graph.body_count());
  if (partition.part_count <= parts) return 0;
  const long gains_counted = Dissolving(graph, most_bodies, partition).run(parts);
  partition = closed_up(partition.part_of_body);
  return gains_counted;
}

}  // namespace cleave
