// What kl and fm share: the gains of moving one body, and the heap that finds the best exchange.
//
// For body i in part A and another part B adjacent to it:
//
//     E_i(B) = sum of w_ij over j in B,
//     I_i    = sum of w_ij over the other j in A,
//     D_i(B) = E_i(B) - I_i.
//
// D_i(B) is the decrease of the total cut weight when i moves to B (Fiduccia & Mattheyses 1982); swapping i
// with j of B decreases it by D_i(B) + D_j(A) - 2 w_ij (Kernighan & Lin 1970), because the edge (i, j) stays
// cut.
#pragma once

#include <span>
#include <vector>

#include "partition/body_graph.h"

namespace cleave {

struct MoveGain {
  int part;  // B
  int gain;  // D_i(B)
};

// Computes D_i(B) of one node for every B adjacent to it, O(degree).
class PartGains {
 public:
  explicit PartGains(int part_count) : slot_(part_count, -1) {}

  // Of a node of part `own` with the edges first .. last - 1: part(k) is what edge k leads into, weight(k)
  // its weight. In the order of the first edge into each part; valid until the next call.
  template <class Part, class Weight>
  std::span<const MoveGain> of(int own, int first, int last, const Part& part, const Weight& weight) {
    gains_.clear();
    int inside = 0;
    for (int k = first; k < last; ++k) {
      const int to = part(k);
      if (to == own) {
        inside += weight(k);
        continue;
      }
      if (slot_[to] < 0) {
        slot_[to] = static_cast<int>(gains_.size());
        gains_.push_back({to, 0});
      }
      gains_[slot_[to]].gain += weight(k);
    }
    for (MoveGain& move : gains_) {
      slot_[move.part] = -1;
      move.gain -= inside;
    }
    return gains_;
  }

 private:
  std::vector<int> slot_;  // (parts): place of a part in gains_, -1 between calls
  std::vector<MoveGain> gains_;
};

// The same of bodies.
class MoveGains {
 public:
  MoveGains(const BodyGraph& graph, EdgeWeight unit, int part_count)
      : graph_(graph), unit_(unit), gains_(part_count) {}

  // In the order of the first neighbour in each part; valid until the next call.
  std::span<const MoveGain> of(int body, std::span<const int> part_of_body);

 private:
  const BodyGraph& graph_;
  const EdgeWeight unit_;
  PartGains gains_;
};

// w_ab, 0 when the bodies are not adjacent.
int edge_weight(const BodyGraph& graph, int a, int b, EdgeWeight unit);

// A possible exchange. The better one compares greater: greater gain, then lower first, then lower second.
struct Exchange {
  int gain = 0;
  int first = 0;   // fm: the body;    kl: the lower body
  int second = 0;  // fm: its target;  kl: the other body
  int tag = 0;     // by which the owner tells a stale entry from a true one; does not order

  bool operator==(const Exchange&) const = default;
  bool operator<(const Exchange& other) const {
    if (gain != other.gain) return gain < other.gain;
    if (first != other.first) return first > other.first;
    return second > other.second;
  }
};

// Best exchange first. Entries are never changed: the owner pushes anew and skips stale ones.
class ExchangeHeap {
 public:
  bool empty() const { return entries_.empty(); }
  void clear() { entries_.clear(); }
  void push(const Exchange& exchange);
  Exchange pop();

 private:
  std::vector<Exchange> entries_;
};

}  // namespace cleave
