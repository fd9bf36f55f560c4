#include "partition/repair.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "partition/move_search.h"

namespace cleave {

Partition closed_up(std::span<const int> part_of_body) {
  Partition partition{{part_of_body.begin(), part_of_body.end()}, 0};
  const int largest = part_of_body.empty() ? -1 : std::ranges::max(part_of_body);
  std::vector<int> id(largest + 1, -1);
  for (const int part : part_of_body)
    if (part >= 0) id[part] = 0;
  for (int& next : id)
    if (next == 0) next = partition.part_count++;
  for (int& part : partition.part_of_body) part = part < 0 ? -1 : id[part];
  return partition;
}

namespace {

// Joins bodies without a part, one at a time.
class Joining {
 public:
  Joining(const BodyGraph& graph, int most_bodies, Partition& partition)
      : graph_(graph), most_bodies_(most_bodies), partition_(partition), bodies_(partition.part_count, 0) {
    for (const int part : partition.part_of_body)
      if (part >= 0) ++bodies_[part];
    weight_.resize(partition.part_count, 0);
  }

  void join(int body) {
    int part = best_for(body);
    if (part < 0) {
      part = partition_.part_count++;
      bodies_.push_back(0);
      weight_.push_back(0);
    }
    partition_.part_of_body[body] = part;
    ++bodies_[part];
  }

 private:
  int best_for(int body) {
    touched_.clear();
    for (int k = graph_.first(body); k < graph_.last(body); ++k) {
      const int part = partition_.part_of_body[graph_.neighbour(k)];
      if (part < 0 || bodies_[part] >= most_bodies_) continue;
      if (weight_[part] == 0) touched_.push_back(part);
      weight_[part] += graph_.weight(k, EdgeWeight::rows);
    }
    int best = -1;
    for (const int part : touched_)
      if (best < 0 || weight_[part] > weight_[best] || (weight_[part] == weight_[best] && part < best))
        best = part;
    for (const int part : touched_) weight_[part] = 0;
    return best;
  }

  const BodyGraph& graph_;
  const int most_bodies_;
  Partition& partition_;
  std::vector<int> bodies_;   // (parts)
  std::vector<int> weight_;   // (parts): of edges into it from the body at hand, 0 between two
  std::vector<int> touched_;  // parts of which it is not 0
};

}  // namespace

Partition take_over(const BodyGraph& graph, std::span<const int> part_of_body, int most_bodies) {
  if (static_cast<int>(part_of_body.size()) != graph.body_count())
    throw std::invalid_argument(std::to_string(part_of_body.size()) + " part ids for " +
                                std::to_string(graph.body_count()) + " bodies");
  Partition partition = closed_up(part_of_body);
  Joining joining(graph, most_bodies, partition);
  for (int body = 0; body < graph.body_count(); ++body)
    if (partition.part_of_body[body] < 0) joining.join(body);
  return partition;
}

void move_changed(const BodyGraph& graph, std::span<const char> may_move, int most_bodies,
                  Partition& partition) {
  std::vector<char> stays(may_move.size());
  std::ranges::transform(may_move, stays.begin(), [](char may) { return may == 0; });
  MoveSearch search(graph, EdgeWeight::rows, most_bodies, MoveKind::improving, partition, stays);
  while (const std::optional<Exchange> move = search.find()) search.make(*move);
}

std::vector<char> changed_bodies(const BodyGraph& before, const BodyGraph& now) {
  std::vector<char> changed(now.body_count(), 1);
  for (int body = 0; body < std::min(before.body_count(), now.body_count()); ++body)
    changed[body] = !std::ranges::equal(before.neighbours(body), now.neighbours(body));
  return changed;
}

}  // namespace cleave
