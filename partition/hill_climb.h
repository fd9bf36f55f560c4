// One climb over hills of the cut: moves that may raise it on the way to a lower one (Fiduccia & Mattheyses
// 1982), as fm-hill and merge-small make them.
//
// The allowed move of greatest gain (move_search.h) is made whatever its sign, and its body locked, until no
// move is left or the last `patience` moves have not led to a cut lower than all before. The climb is then
// taken back to its first moment of least cut, so it never ends worse than it began. Bodies stay locked until
// the search lets them go.
#pragma once

#include <span>
#include <vector>

#include "partition/move_search.h"

namespace cleave {

class HillClimb {
 public:
  // search: of MoveKind::all, on this partition. patience >= 1.
  HillClimb(MoveSearch& search, const Partition& partition, int patience)
      : search_(search), partition_(partition), patience_(patience) {}

  // From what the search was last started with. Returns by how much the cut fell, 0 where nothing was kept.
  long run();

  struct Made {
    int body, from;  // and the part that it left
  };
  // Of the last run, in order.
  std::span<const Made> kept() const { return std::span(moves_).first(kept_); }
  std::span<const Made> taken_back() const { return std::span(moves_).subspan(kept_); }

 private:
  MoveSearch& search_;
  const Partition& partition_;
  const int patience_;
  std::vector<Made> moves_;
  std::size_t kept_ = 0;
};

}  // namespace cleave
