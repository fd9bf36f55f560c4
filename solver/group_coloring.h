// Colours for the groups of rows of a prepared step, so that groups of one colour share no dynamic body and
// may be worked on at once. It is a colouring of the dual graph, whose nodes are constraints, adjacent where
// they share a dynamic body (Fratarcangeli, Tibaldo, Pellacini: Vivace, ACM Transactions on Graphics 35(6),
// 2016); constraints between the same two bodies, which are adjacent to each other and to the same others,
// are one node here.
//
// `greedy`: each group in turn takes the least colour that no group before it on one of its bodies has. A
// group refused c colours has c neighbours, one of each, so there are at most as many colours as the largest
// degree plus one. `vivace`: by chance (vivace_coloring.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/prepared_step.h"
#include "solver/vivace_coloring.h"

namespace cleave {

class GroupColoring {
 public:
  // groups: of bodies 0 .. body_count - 1. Depends on these alone; buffers are kept.
  void color(int body_count, std::span<const RowGroup> groups);
  void color_by_chance(int body_count, std::span<const RowGroup> groups, std::uint64_t seed);

  int color_count() const { return static_cast<int>(first_.size()) - 1; }
  // The groups of a colour, ascending.
  std::span<const int> groups_of(int color) const {
    return std::span(groups_).subspan(first_[color], first_[color + 1] - first_[color]);
  }

 private:
  std::vector<int> first_ = {0};  // of each colour, in groups_
  std::vector<int> groups_;       // by colour
  // Scratch: groups without a colour yet; of each body, the last colour that a group of it has.
  std::vector<int> left_, last_color_;
  VivaceColoring vivace_;
};

}  // namespace cleave
