// Where the next group of rows finds its lane, while octets (slab_rows.h) are filled.
#pragma once

#include <algorithm>
#include <array>

#include "solver/slab_rows.h"

namespace cleave {

// Octets that a group may still join, the oldest first. Sixteen at most: of one body in very many groups,
// each needs an octet of its own.
class OpenOctets {
 public:
  // The first with neither body; -1: none. body_b: -1 for what does not move.
  int find(int body_a, int body_b) const {
    for (int i = 0; i < count_; ++i)
      if (!has(i, body_a) && (body_b < 0 || !has(i, body_b))) return i;
    return -1;
  }
  // Returns its place here, as find() does; where there are too many, the oldest is closed.
  int open(int octet) {
    if (count_ == kMost) close(0);
    open_[count_] = {.octet = octet};
    open_[count_].bodies.fill(-1);
    return count_++;
  }
  // Which one it is, of those that were opened.
  int octet(int i) const { return open_[i].octet; }
  // Returns the lane of the group; one that is full is closed.
  int add(int i, int body_a, int body_b) {
    const int lane = open_[i].groups++;
    open_[i].bodies[lane] = body_a;
    open_[i].bodies[kOctetLanes + lane] = body_b;
    if (open_[i].groups == kOctetLanes) close(i);
    return lane;
  }

 private:
  static constexpr int kMost = 16;
  struct Open {
    int octet = 0, groups = 0;
    std::array<int, 2 * kOctetLanes> bodies{};
  };

  // All sixteen, which a vector compares at once.
  bool has(int i, int body) const {
    int found = 0;
    for (const int other : open_[i].bodies) found |= other == body;
    return found != 0;
  }
  void close(int i) { std::move(open_.begin() + i + 1, open_.begin() + count_--, open_.begin() + i); }

  std::array<Open, kMost> open_;
  int count_ = 0;
};

}  // namespace cleave
