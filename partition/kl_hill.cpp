// kl-hill: swaps bodies of two parts in passes that also take steps that raise the cut (Kernighan & Lin
// 1970).
//
// For every pair of adjacent parts A < B, in ascending order, a pass: all bodies of A and B are free; the
// swap of greatest gain
//
//     D_i(B) + D_j(A) - 2 w_ij,     D_i(B) = E_i - I_i between these two parts,
//
// among the free i of A and j of B is made whatever its sign, ties to the lowest min(i, j), then to the
// lowest max(i, j), and both are locked, until one part has no free body. The pass is then taken back to its
// first moment of least cut, and repeated while it lowers the cut. Rounds over all pairs follow until one
// brings nothing. Sizes of parts do not change, and the result is never worse than the start.
#include <algorithm>
#include <limits>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "partition/gains.h"
#include "partition/parameters.h"
#include "partition/refiner.h"
#include "partition/swap_search.h"

namespace cleave {
namespace {

class PairPasses {
 public:
  PairPasses(const BodyGraph& graph, EdgeWeight unit, Partition& partition)
      : graph_(graph), unit_(unit), part_of_body_(partition.part_of_body), gain_(graph.body_count()) {}

  // Passes between two parts while they lower the cut; what they lower it by.
  long run(int a, int b, RefineSummary& summary) {
    long lowered = 0;
    while (const long gain = pass(a, b, summary)) lowered += gain;
    return lowered;
  }

  void list_bodies(int parts) {
    bodies_.assign(parts, {});
    for (std::size_t body = 0; body < part_of_body_.size(); ++body)
      bodies_[part_of_body_[body]].push_back(static_cast<int>(body));
  }

 private:
  long pass(int a, int b, RefineSummary& summary) {
    for (const int part : {a, b})
      for (const int body : bodies_[part]) gain_[body] = gain_of(body, a, b);
    std::vector<SwapCandidate> ours = candidates(a), theirs = candidates(b);
    std::vector<std::pair<int, int>> swaps;
    std::size_t kept = 0;
    long total = 0, best = 0;
    while (!ours.empty() && !theirs.empty()) {
      order(ours);
      order(theirs);
      const Exchange swap = *best_swap(graph_, unit_, ours, theirs, std::numeric_limits<int>::min());
      const auto [i, j] = part_of_body_[swap.first] == a ? std::pair(swap.first, swap.second)
                                                         : std::pair(swap.second, swap.first);
      erase(i, ours);
      erase(j, theirs);
      move(i, a, b);
      move(j, b, a);
      swaps.emplace_back(i, j);
      total += swap.gain;
      if (total <= best) continue;
      best = total;
      kept = swaps.size();
    }
    for (std::size_t k = swaps.size(); k > kept; --k) {
      part_of_body_[swaps[k - 1].first] = a;
      part_of_body_[swaps[k - 1].second] = b;
    }
    for (std::size_t k = 0; k < kept; ++k) {
      std::ranges::replace(bodies_[a], swaps[k].first, swaps[k].second);
      std::ranges::replace(bodies_[b], swaps[k].second, swaps[k].first);
    }
    summary.exchanges += static_cast<int>(kept);
    return best;
  }

  int gain_of(int body, int a, int b) const {
    int gain = 0;
    for (int k = graph_.first(body); k < graph_.last(body); ++k) {
      const int part = part_of_body_[graph_.neighbour(k)], weight = graph_.weight(k, unit_);
      if (part == part_of_body_[body]) {
        gain -= weight;
      } else if (part == a || part == b) {
        gain += weight;
      }
    }
    return gain;
  }

  // D of the body's neighbours in both parts follows.
  void move(int body, int from, int to) {
    part_of_body_[body] = to;
    for (int k = graph_.first(body); k < graph_.last(body); ++k) {
      const int other = graph_.neighbour(k), weight = graph_.weight(k, unit_);
      if (part_of_body_[other] == from) gain_[other] += 2 * weight;
      if (part_of_body_[other] == to) gain_[other] -= 2 * weight;
    }
  }

  std::vector<SwapCandidate> candidates(int part) const {
    std::vector<SwapCandidate> side;
    for (const int body : bodies_[part]) side.push_back({0, body});
    return side;
  }

  static void erase(int body, std::vector<SwapCandidate>& side) {
    std::erase_if(side, [body](const SwapCandidate& candidate) { return candidate.body == body; });
  }

  // With their present D.
  void order(std::vector<SwapCandidate>& side) const {
    for (SwapCandidate& candidate : side) candidate.gain = gain_[candidate.body];
    std::sort(side.begin(), side.end());
  }

  const BodyGraph& graph_;
  const EdgeWeight unit_;
  std::vector<int>& part_of_body_;
  std::vector<int> gain_;                 // (n) D towards the other part of the pair
  std::vector<std::vector<int>> bodies_;  // by part
};

class KlHill final : public Refiner {
 public:
  explicit KlHill(const Settings& settings) : Refiner(settings.word<EdgeWeight>(parameters::edge_weight())) {}

 private:
  void do_run(const BodyGraph& graph, int, Partition& partition, RefineSummary& summary) const override {
    PairPasses passes(graph, unit(), partition);
    passes.list_bodies(partition.part_count);
    long lowered = 1;
    while (lowered > 0) {
      lowered = 0;
      for (const auto& [a, b] : adjacent_parts(graph, partition)) lowered += passes.run(a, b, summary);
      summary.cut_after -= lowered;
    }
  }

  static std::set<std::pair<int, int>> adjacent_parts(const BodyGraph& graph, const Partition& partition) {
    std::set<std::pair<int, int>> pairs;
    for (int body = 0; body < graph.body_count(); ++body) {
      const int part = partition.part_of_body[body];
      for (const int other : graph.neighbours(body))
        if (partition.part_of_body[other] > part) pairs.emplace(part, partition.part_of_body[other]);
    }
    return pairs;
  }
};

}  // namespace

std::unique_ptr<Refiner> make_kl_hill(const Settings& settings) { return std::make_unique<KlHill>(settings); }

}  // namespace cleave
