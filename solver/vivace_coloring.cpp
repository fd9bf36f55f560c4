#include "solver/vivace_coloring.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace cleave {

void VivaceColoring::list_neighbours(int body_count, std::span<const RowGroup> groups) {
  const int count = static_cast<int>(groups.size());
  first_of_body_.assign(body_count + 1, 0);
  const auto visit = [&](const auto& visit_body) {
    for (int g = 0; g < count; ++g)
      for (const int body : {groups[g].body_a, groups[g].body_b})
        if (body >= 0) visit_body(body, g);
  };
  visit([&](int body, int) { ++first_of_body_[body]; });
  std::partial_sum(first_of_body_.begin(), first_of_body_.end(), first_of_body_.begin());
  of_body_.resize(first_of_body_.back());
  visit([&](int body, int g) { of_body_[--first_of_body_[body]] = g; });

  first_.assign(1, 0);
  neighbours_.clear();
  seen_by_.assign(count, -1);
  for (int g = 0; g < count; ++g) {
    seen_by_[g] = g;
    for (const int body : {groups[g].body_a, groups[g].body_b}) {
      for (int i = body < 0 ? 0 : first_of_body_[body]; body >= 0 && i < first_of_body_[body + 1]; ++i)
        if (std::exchange(seen_by_[of_body_[i]], g) != g) neighbours_.push_back(of_body_[i]);
    }
    first_.push_back(static_cast<int>(neighbours_.size()));
  }
}

void VivaceColoring::draw(int group, Dice& dice) {
  is_free_.assign(palette_[group], 1);
  int free_count = palette_[group];
  for (const int other : neighbours(group)) {
    const int taken = color_[other];
    if (taken >= 0 && taken < palette_[group]) free_count -= std::exchange(is_free_[taken], 0);
  }
  drawn_[group] = -1;
  if (free_count == 0) {
    ++palette_[group];
    return;
  }
  int place = static_cast<int>(dice.below(free_count));
  int color = 0;
  while (!is_free_[color] || place-- > 0) ++color;
  drawn_[group] = color;
}

bool VivaceColoring::may_keep(int group) const {
  return drawn_[group] >= 0 && std::ranges::none_of(neighbours(group), [&](int other) {
           return other < group && drawn_[other] == drawn_[group];
         });
}

std::span<const int> VivaceColoring::color(int body_count, std::span<const RowGroup> groups,
                                           std::uint64_t seed) {
  Dice dice(seed);
  list_neighbours(body_count, groups);
  color_.assign(groups.size(), -1);
  drawn_.assign(groups.size(), -1);
  palette_.resize(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g)
    palette_[g] = std::max(1, static_cast<int>(neighbours(static_cast<int>(g)).size() / kShrinking));
  left_.resize(groups.size());
  std::iota(left_.begin(), left_.end(), 0);
  while (!left_.empty()) {
    for (const int g : left_) draw(g, dice);
    for (const int g : left_)
      if (may_keep(g)) color_[g] = drawn_[g];
    for (const int g : left_) drawn_[g] = -1;
    std::erase_if(left_, [&](int g) { return color_[g] >= 0; });
  }
  return color_;
}

}  // namespace cleave
