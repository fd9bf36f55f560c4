// What all that move single bodies share: the allowed move of greatest gain, again and again.
//
// A move takes body i of part A into a part B adjacent to i; its gain is D_i(B) (gains.h). It is allowed when
// A keeps at least one body and B has at most most_bodies after it, and when i is not locked. Ties go to the
// lowest body, then to the lowest B. The heap holds every move that counts, except those parked because a
// part is full or would be emptied.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "partition/gains.h"
#include "partition/partition.h"

namespace cleave {

// Which moves count: all, or those of positive gain.
enum class MoveKind { all, improving };

class MoveSearch {
 public:
  // stays: (n) 1 for bodies that never move, or empty: all may.
  MoveSearch(const BodyGraph& graph, EdgeWeight unit, int most_bodies, MoveKind kind, Partition& partition,
             std::span<const char> stays = {});

  // The best allowed move (its tag is the search's own); none when there is none.
  std::optional<Exchange> find();
  void make(const Exchange& move);
  void lock(int body) { is_locked_[body] = 1; }
  void release(int body) { is_locked_[body] = stays_[body]; }
  // Every body that does not stay is free again, and the partition may have been changed.
  void restart();
  // The search goes on with the moves of this body alone and, after each that is made, those of the bodies
  // next to it. What is locked stays so.
  void restart_at(int body);
  // Takes back what was made last of those not yet taken back; a restart must follow before the next find().
  void put_back(int body, int from);
  // Gains worked out since it was made: what all this costs, but for a logarithm.
  long gains_counted() const { return gains_counted_; }

 private:
  void push_moves(int body);
  bool park_if_blocked(const Exchange& move);
  void unpark(int part);
  void forget_moves();

  const BodyGraph& graph_;
  Partition& partition_;
  const int most_bodies_;
  const MoveKind kind_;
  MoveGains gains_;
  std::vector<int> bodies_;      // (parts)
  std::vector<int> version_;     // (n): moves pushed before the body's gains last changed are stale
  std::vector<char> stays_;      // (n)
  std::vector<char> is_locked_;  // (n)
  std::vector<std::vector<Exchange>> parked_;  // (parts)
  std::vector<int> parked_at_;                 // parts where some were parked since the last restart
  ExchangeHeap moves_;
  long gains_counted_ = 0;
};

}  // namespace cleave
