#include "partition/local_climbs.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "partition/hill_climb.h"

namespace cleave {
namespace {

class Rounds {
 public:
  Rounds(const BodyGraph& graph, const LocalClimbs& options, Partition& partition)
      : graph_(graph),
        search_(graph, EdgeWeight::rows, options.most_bodies, MoveKind::all, partition),
        climb_(search_, partition, options.patience),
        looks_at_(graph.body_count(), 0),
        looks_next_at_(graph.body_count(), 1) {}

  // Whether there is something for another round.
  bool round() {
    std::swap(looks_at_, looks_next_at_);
    std::ranges::fill(looks_next_at_, 0);
    for (int body = 0; body < graph_.body_count(); ++body)
      if (looks_at_[body] != 0) climb_from(body);
    for (const int body : stay_) search_.release(body);
    const bool again = !stay_.empty();
    stay_.clear();
    return again;
  }

  long gains_counted() const { return search_.gains_counted(); }

 private:
  void climb_from(int body) {
    search_.restart_at(body);
    climb_.run();
    for (const HillClimb::Made& made : climb_.taken_back()) search_.release(made.body);
    for (const HillClimb::Made& made : climb_.kept()) {
      stay_.push_back(made.body);
      looks_next_at_[made.body] = 1;
      for (const int other : graph_.neighbours(made.body)) looks_next_at_[other] = 1;
    }
  }

  const BodyGraph& graph_;
  MoveSearch search_;
  HillClimb climb_;
  std::vector<char> looks_at_, looks_next_at_;  // (n)
  std::vector<int> stay_;                       // moved in this round
};

}  // namespace

long climb_locally(const BodyGraph& graph, const LocalClimbs& options, Partition& partition) {
  Rounds rounds(graph, options, partition);
  for (int k = 0; k < options.most_rounds && rounds.round(); ++k) {
  }
  return rounds.gains_counted();
}

}  // namespace cleave
