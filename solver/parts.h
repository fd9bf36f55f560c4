// How the bodies of a step are split into subsystems: one level of parts, or a tree of them.
//
//   part_of_body    (n) ids 0..parts-1 of the subsystems
//   parent_of_part  empty: one level. Otherwise one entry a node of the tree: the leaves 0..parts-1, which
//                   are the parts, then the inner nodes, each the union of its children. Every parent has a
//                   greater number than its children; -1 for the root, which is the last node and the only
//                   root. A single part is its own root.
//   kernel          for which they were chosen, as the registry calls it; empty: for none. Solvers of a named
//                   kernel do not look at it.
#pragma once

#include <algorithm>
#include <concepts>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cleave {

// Looks at arrays of somebody else, which must outlive it.
struct Parts {
  Parts() = default;

  // From whatever holds one part id per body: parts are then one level unless parents are given too.
  template <class Ids>
  requires std::convertible_to<const Ids&, std::span<const int>> Parts(
      const Ids& part_of_body, std::span<const int> parent_of_part = {})
      : part_of_body(part_of_body), parent_of_part(parent_of_part) {}

  std::span<const int> part_of_body;
  std::span<const int> parent_of_part;
  std::string_view kernel;
};

// Ids are 0..parts-1: one more than the greatest, 0 of no bodies.
inline int count_parts(std::span<const int> part_of_body) {
  return part_of_body.empty() ? 0 : 1 + std::ranges::max(part_of_body);
}

// Keeps its scratch, so that parts as large as those before allocate nothing.
class PartsCheck {
 public:
  // Empty, or in one line what is wrong with parts of so many bodies: entry, value and what is allowed.
  std::string find_error(const Parts& parts, int bodies);

  // The same, but the ids of a single level are not looked at, only how many there are.
  std::string find_tree_error(const Parts& parts, int bodies);

 private:
  std::string find_parent_error(std::span<const int> parent_of_part);

  std::vector<bool> has_child_;  // (nodes)
};

}  // namespace cleave
