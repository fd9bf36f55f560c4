// The best swap of two bodies between two parts, as kl and kl-hill look for it.
#pragma once

#include <optional>
#include <span>

#include "partition/gains.h"

namespace cleave {

// A body of one part, with D, what its move to the other would lower the cut by. Sides are kept by falling D,
// then rising index.
struct SwapCandidate {
  int gain;  // D
  int body;
  bool operator==(const SwapCandidate&) const = default;
  bool operator<(const SwapCandidate& other) const {
    return gain != other.gain ? gain > other.gain : body < other.body;
  }
};

// Of greatest gain D_i + D_j - 2 w_ij, ties to the lowest min(i, j), then to the lowest max(i, j); its tag is
// 0. ours, theirs: ascending. Nothing where no swap gains `least`. The search ends as soon as D_i + D_j
// cannot reach the best found.
std::optional<Exchange> best_swap(const BodyGraph& graph, EdgeWeight unit,
                                  std::span<const SwapCandidate> ours, std::span<const SwapCandidate> theirs,
                                  int least);

}  // namespace cleave
