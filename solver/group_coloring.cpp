#include "solver/group_coloring.h"

#include <algorithm>
#include <numeric>

#include "solver/counting_sort.h"

namespace cleave {

// Colour after colour: of the groups that have none yet, those whose bodies do not have this one take it.
// That gives each group the colour that it would take in its turn.
void GroupColoring::color(int body_count, std::span<const RowGroup> groups) {
  first_.assign(1, 0);
  groups_.clear();
  groups_.reserve(groups.size());
  left_.resize(groups.size());
  std::iota(left_.begin(), left_.end(), 0);
  last_color_.assign(body_count, -1);
  while (!left_.empty()) {
    const int color = color_count();
    std::size_t kept = 0;
    for (const int g : left_) {
      const int a = groups[g].body_a, b = groups[g].body_b < 0 ? a : groups[g].body_b;
      if (last_color_[a] == color || last_color_[b] == color) {
        left_[kept++] = g;
      } else {
        last_color_[a] = last_color_[b] = color;
        groups_.push_back(g);
      }
    }
    left_.resize(kept);
    first_.push_back(static_cast<int>(groups_.size()));
  }
}

void GroupColoring::color_by_chance(int body_count, std::span<const RowGroup> groups, std::uint64_t seed) {
  const std::span<const int> color = vivace_.color(body_count, groups, seed);
  const int colors = color.empty() ? 0 : 1 + *std::ranges::max_element(color);
  sort_into_buckets(
      static_cast<int>(groups.size()), colors, [&](int g) { return color[g]; }, first_, groups_);
}

}  // namespace cleave
