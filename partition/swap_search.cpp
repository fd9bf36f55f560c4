#include "partition/swap_search.h"

#include <algorithm>

namespace cleave {

std::optional<Exchange> best_swap(const BodyGraph& graph, EdgeWeight unit,
                                  std::span<const SwapCandidate> ours, std::span<const SwapCandidate> theirs,
                                  int least) {
  std::optional<Exchange> best;
  if (theirs.empty()) return best;
  for (const SwapCandidate& i : ours) {
    if (i.gain + theirs.front().gain < least) break;
    for (const SwapCandidate& j : theirs) {
      const int at_most = i.gain + j.gain;
      if (at_most < least) break;
      const int shared = edge_weight(graph, i.body, j.body, unit);
      const Exchange swap{at_most - 2 * shared, std::min(i.body, j.body), std::max(i.body, j.body), 0};
      if (swap.gain >= least && (!best || *best < swap)) {
        best = swap;
        least = swap.gain;
      }
      // The rest of the side has no greater D, and a higher index where D is equal: it loses against this j.
      if (shared == 0) break;
    }
  }
  return best;
}

}  // namespace cleave
