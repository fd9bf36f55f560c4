#include "solver/interface_split.h"
#include "solver/parts.h"

#include <algorithm>

namespace cleave {

void InterfaceSplit::split(const PreparedStep& step, std::span<const int> part_of_body) {
  part_count = count_parts(part_of_body);
  if (static_cast<int>(parts.size()) < part_count) parts.resize(part_count);
  for (PartRows& part : parts) {
    part.bodies.clear();
    part.groups.clear();
    part.cut_rows.clear();
    part.cut_side.clear();
  }
  local_of_body.resize(part_of_body.size());
  for (std::size_t body = 0; body < part_of_body.size(); ++body) {
    std::vector<int>& bodies = parts[part_of_body[body]].bodies;
    local_of_body[body] = static_cast<int>(bodies.size());
    bodies.push_back(static_cast<int>(body));
  }
  cut_rows.clear();
  for (std::size_t g = 0; g < step.groups().size(); ++g) {
    const RowGroup& group = step.groups()[g];
    const int part_a = part_of_body[group.body_a];
    const int part_b = group.body_b < 0 ? part_a : part_of_body[group.body_b];
    if (part_a == part_b) {
      parts[part_a].groups.push_back(static_cast<int>(g));
      continue;
    }
    for (int r = group.first_row; r < group.first_row + group.row_count; ++r) {
      for (int side = 0; side < 2; ++side) {
        PartRows& part = parts[side == 0 ? part_a : part_b];
        part.cut_rows.push_back(static_cast<int>(cut_rows.size()));
        part.cut_side.push_back(side);
      }
      cut_rows.push_back(r);
    }
  }
}

}  // namespace cleave
