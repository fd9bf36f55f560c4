// kl: swaps bodies between parts (Liu & Andrews 2022, section 3.2, after Kernighan & Lin 1970).
//
// A swap exchanges i of part A, adjacent to B, with j of part B, adjacent to A; i and j need not be adjacent.
// Its gain is
//
//     D_i(B) + D_j(A) - 2 w_ij,     D_i(B) = E_i - I_i.
//
// Over all adjacent pairs of parts the swap of greatest gain is made, ties to the lowest min(i, j), then to
// the lowest max(i, j); gains are recomputed after each swap; it ends when none is positive. Sizes of parts
// do not change.
//
// For every pair of parts the bodies of either side are kept in the order of the search (swap_search.h). It
// is repeated only for pairs whose sides changed; a heap holds the best swap of every pair.
#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "partition/gains.h"
#include "partition/refiner.h"
#include "partition/swap_search.h"

namespace cleave {
namespace {

// The bodies of one part that are adjacent to another part, by falling D, then rising index.
class Side {
 public:
  Side() { candidates_.reserve(8); }  // few sides are longer: one allocation instead of four

  void insert(const SwapCandidate& candidate) {
    candidates_.insert(std::lower_bound(candidates_.begin(), candidates_.end(), candidate), candidate);
  }
  void erase(const SwapCandidate& candidate) {
    candidates_.erase(std::lower_bound(candidates_.begin(), candidates_.end(), candidate));
  }
  const std::vector<SwapCandidate>& candidates() const { return candidates_; }

 private:
  std::vector<SwapCandidate> candidates_;
};

struct PartPair {
  std::array<Side, 2> side;  // of the lower part, of the higher part
  Exchange best;             // gain 0: no swap of positive gain
  bool changed = false;
};

class SwapSearch {
 public:
  SwapSearch(const BodyGraph& graph, EdgeWeight unit, Partition& partition)
      : graph_(graph),
        unit_(unit),
        part_of_body_(partition.part_of_body),
        gains_(graph, unit, partition.part_count),
        pairs_of_part_(partition.part_count),
        is_affected_(graph.body_count(), false) {
    for (int i = 0; i < graph.body_count(); ++i) enter(i, -1, -1);
    search_changed_pairs();
  }

  void run(RefineSummary& summary) {
    while (!swaps_.empty()) {
      const Exchange swap = swaps_.pop();
      if (!(swap == pairs_[swap.tag].best)) continue;  // stale
      make(swap);
      ++summary.exchanges;
      summary.cut_after -= swap.gain;
    }
  }

 private:
  // Puts the body on its side of every pair its part makes with an adjacent part. After a swap between a and
  // b, bodies of other parts changed only towards a and b; the other sides are left alone then (a, b = -1:
  // take all).
  void enter(int body, int a, int b) {
    visit_sides(body, a, b, [](Side& side, SwapCandidate candidate) { side.insert(candidate); });
  }

  // Undoes enter; must be called before a part id or gain of the body changes.
  void leave(int body, int a, int b) {
    visit_sides(body, a, b, [](Side& side, SwapCandidate candidate) { side.erase(candidate); });
  }

  template <class Visit>
  void visit_sides(int body, int a, int b, Visit visit) {
    const int own = part_of_body_[body];
    const bool all = a < 0 || own == a || own == b;
    for (const MoveGain& move : gains_.of(body, part_of_body_)) {
      if (!all && move.part != a && move.part != b) continue;
      const int id = pair_id(own, move.part);
      visit(pairs_[id].side[own < move.part ? 0 : 1], {move.gain, body});
      if (!std::exchange(pairs_[id].changed, true)) changed_.push_back(id);
    }
  }

  int pair_id(int a, int b) {
    for (const auto& [other, id] : pairs_of_part_[a]) {
      if (other == b) return id;
    }
    const int id = static_cast<int>(pairs_.size());
    pairs_.emplace_back();
    pairs_of_part_[a].emplace_back(b, id);
    pairs_of_part_[b].emplace_back(a, id);
    return id;
  }

  void make(const Exchange& swap) {
    const int a = part_of_body_[swap.first];
    const int b = part_of_body_[swap.second];
    gather_affected(swap.first, swap.second);
    for (int body : affected_) leave(body, a, b);
    std::swap(part_of_body_[swap.first], part_of_body_[swap.second]);
    for (int body : affected_) enter(body, a, b);
    search_changed_pairs();
  }

  // The two bodies and all their neighbours, each once.
  void gather_affected(int first, int second) {
    affected_.clear();
    const auto add = [&](int body) {
      if (!std::exchange(is_affected_[body], 1)) affected_.push_back(body);
    };
    for (int body : {first, second}) {
      add(body);
      for (int other : graph_.neighbours(body)) add(other);
    }
    for (int body : affected_) is_affected_[body] = 0;
  }

  void search_changed_pairs() {
    for (int id : changed_) {
      PartPair& pair = pairs_[id];
      pair.changed = false;
      const auto found = best_swap(graph_, unit_, pair.side[0].candidates(), pair.side[1].candidates(), 1);
      pair.best = found.value_or(Exchange{});
      pair.best.tag = id;
      if (found) swaps_.push(pair.best);
    }
    changed_.clear();
  }

  const BodyGraph& graph_;
  const EdgeWeight unit_;
  std::vector<int>& part_of_body_;
  MoveGains gains_;
  std::vector<PartPair> pairs_;
  std::vector<std::vector<std::pair<int, int>>> pairs_of_part_;  // (parts): other part, place in pairs_
  std::vector<int> changed_;                                     // places in pairs_
  std::vector<int> affected_;                                    // scratch of make
  std::vector<char> is_affected_;                                // (n), all 0 between calls
  ExchangeHeap swaps_;                                           // tag: place in pairs_
};

class KernighanLin final : public Refiner {
 public:
  explicit KernighanLin(const Settings& settings) : Refiner(refining_unit(settings)) {}

 private:
  void do_run(const BodyGraph& graph, int, Partition& partition, RefineSummary& summary) const override {
    SwapSearch(graph, unit(), partition).run(summary);
  }
};

}  // namespace

std::unique_ptr<Refiner> make_kernighan_lin(const Settings& settings) {
  return std::make_unique<KernighanLin>(settings);
}

}  // namespace cleave
