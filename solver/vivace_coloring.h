// Colours for the groups of rows of a step by chance: Fratarcangeli, Tibaldo, Pellacini: Vivace, ACM
// Transactions on Graphics 35(6), 2016, section 4.1 (algorithm 1). Nodes are groups, adjacent where they
// share a dynamic body (group_coloring.h).
//
// Each node has a palette, at first of its number of neighbours over kShrinking colours. In a round every
// node without a colour
//
//     draws one of its palette that no neighbour has got,
//     keeps it where no neighbour before it, by number, drew the same in this round,
//     gets one more colour into its palette where none of it is left.
//
// Rounds go on until every node has a colour. (Two neighbours with the same single colour would draw it for
// ever if neither kept it.) What is drawn comes from the seed and the order of nodes alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "harness/base/dice.h"
#include "solver/prepared_step.h"

namespace cleave {

class VivaceColoring {
 public:
  static constexpr double kShrinking = 2.5;

  // (groups) A colour each. groups: of bodies 0 .. body_count - 1. Buffers are kept.
  std::span<const int> color(int body_count, std::span<const RowGroup> groups, std::uint64_t seed);

 private:
  void list_neighbours(int body_count, std::span<const RowGroup> groups);
  void draw(int group, Dice& dice);
  bool may_keep(int group) const;
  std::span<const int> neighbours(int group) const {
    return std::span(neighbours_).subspan(first_[group], first_[group + 1] - first_[group]);
  }

  std::vector<int> color_, drawn_, palette_;   // of each group; -1: none
  std::vector<int> first_, neighbours_;        // of each group
  std::vector<int> first_of_body_, of_body_;   // groups of each body
  std::vector<int> left_, seen_by_, is_free_;  // scratch
};

}  // namespace cleave
