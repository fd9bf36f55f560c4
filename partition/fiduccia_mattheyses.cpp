// fm: moves single bodies between parts (Liu & Andrews 2022, section 3.2, after Fiduccia & Mattheyses 1982).
//
// A move takes body i of part A into a part B adjacent to i; its gain is E_i - I_i. It is allowed when A
// keeps at least one body and B stays at or below
//
//     floor((1 + max-growth) max_bodies + 1e-9)      (as-printed: no bound).
//
// The allowed move of greatest gain is made, ties to the lowest body, then to the lowest B, until none has a
// positive gain. Every move lowers the cut, so this ends. A part above the bound to begin with may shrink but
// not grow.
#include <algorithm>
#include <cmath>
#include <memory>

#include "partition/gains.h"
#include "partition/refiner.h"

namespace cleave {
namespace {

// The heap holds every move of positive gain, except those parked because a part is full or would be emptied.
class MoveSearch {
 public:
  MoveSearch(const BodyGraph& graph, EdgeWeight unit, int most_bodies, Partition& partition)
      : graph_(graph),
        part_of_body_(partition.part_of_body),
        most_bodies_(most_bodies),
        gains_(graph, unit, partition.part_count),
        bodies_(part_sizes(partition)),
        version_(graph.body_count(), 0),
        parked_(partition.part_count) {
    for (int i = 0; i < graph.body_count(); ++i) push_moves(i);
  }

  RefineSummary run(long cut_before) {
    RefineSummary summary{0, cut_before, cut_before};
    while (!moves_.empty()) {
      const Exchange move = moves_.pop();
      if (move.tag != version_[move.first] || park_if_blocked(move)) continue;
      make(move);
      ++summary.exchanges;
      summary.cut_after -= move.gain;
    }
    return summary;
  }

 private:
  void push_moves(int body) {
    for (const MoveGain& move : gains_.of(body, part_of_body_)) {
      if (move.gain > 0) moves_.push({move.gain, body, move.part, version_[body]});
    }
  }

  // A blocked move can become possible only when the part that blocks it changes size: it waits there.
  bool park_if_blocked(const Exchange& move) {
    const int source = part_of_body_[move.first];
    const int target = move.second;
    if (bodies_[target] >= most_bodies_) {
      parked_[target].push_back(move);
    } else if (bodies_[source] == 1) {
      parked_[source].push_back(move);
    } else {
      return false;
    }
    return true;
  }

  void unpark(int part) {
    for (const Exchange& move : parked_[part]) {
      if (move.tag == version_[move.first]) moves_.push(move);
    }
    parked_[part].clear();
  }

  void make(const Exchange& move) {
    const int body = move.first;
    const int source = part_of_body_[body];
    part_of_body_[body] = move.second;
    --bodies_[source];
    ++bodies_[move.second];
    ++version_[body];
    push_moves(body);
    for (int other : graph_.neighbours(body)) {
      ++version_[other];
      push_moves(other);
    }
    unpark(source);
    unpark(move.second);
  }

  const BodyGraph& graph_;
  std::vector<int>& part_of_body_;
  const int most_bodies_;
  MoveGains gains_;
  std::vector<int> bodies_;   // (parts)
  std::vector<int> version_;  // (n): moves pushed before the body's gains last changed are stale
  std::vector<std::vector<Exchange>> parked_;  // (parts)
  ExchangeHeap moves_;
};

class FiducciaMattheyses final : public Refiner {
 public:
  explicit FiducciaMattheyses(const Settings& settings)
      : Refiner(refining_unit(settings)),
        max_growth_(settings.number("max-growth")),
        bounded_(!settings.flag("as-printed")) {}

 private:
  RefineSummary do_run(const BodyGraph& graph, int max_bodies, Partition& partition) const override {
    const long cut_before = cut_weight(graph, partition.part_of_body, unit());
    return MoveSearch(graph, unit(), most_bodies(graph, max_bodies), partition).run(cut_before);
  }

  int most_bodies(const BodyGraph& graph, int max_bodies) const {
    const double all = graph.body_count();
    if (!bounded_) return graph.body_count();
    return static_cast<int>(std::min(all, std::floor((1 + max_growth_) * max_bodies + 1e-9)));
  }

  double max_growth_;
  bool bounded_;
};

}  // namespace

std::unique_ptr<Refiner> make_fiduccia_mattheyses(const Settings& settings) {
  return std::make_unique<FiducciaMattheyses>(settings);
}

}  // namespace cleave
