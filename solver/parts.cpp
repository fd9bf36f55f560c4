#include "solver/parts.h"

namespace cleave {
namespace {

std::string entry_text(const char* array, int index, int value, const std::string& allowed) {
  return std::string(array) + "[" + std::to_string(index) + "] = " + std::to_string(value) +
         ", allowed: " + allowed;
}

// "0", "0 to 3".
std::string range_text(int first, int last) {
  return std::to_string(first) + (last > first ? " to " + std::to_string(last) : "");
}

// ids: 0..count - 1.
std::string find_id_error(std::span<const int> part_of_body, int count, const char* what) {
  for (std::size_t body = 0; body < part_of_body.size(); ++body) {
    const int part = part_of_body[body];
    if (part < 0 || part >= count)
      return entry_text("part_of_body", static_cast<int>(body), part, range_text(0, count - 1) + what);
  }
  return {};
}

}  // namespace

// A parent comes later, so that the last node is a root and no walk upwards goes round in circles.
std::string PartsCheck::find_parent_error(std::span<const int> parent_of_part) {
  const int nodes = static_cast<int>(parent_of_part.size());
  has_child_.assign(nodes, false);
  for (int node = 0; node < nodes; ++node) {
    const int parent = parent_of_part[node];
    const bool is_last = node == nodes - 1;
    if (is_last ? parent != -1 : parent <= node || parent >= nodes)
      return entry_text("parent_of_part", node, parent,
                        is_last ? "-1, the root" : range_text(node + 1, nodes - 1) + ", a later node");
    if (!is_last) has_child_[parent] = true;
  }
  for (int node = 1; node < nodes; ++node)
    if (has_child_[node - 1] && !has_child_[node])
      return "parent_of_part: node " + std::to_string(node) +
             " has no children and comes after one that has, allowed: leaves before inner nodes";
  return {};
}

std::string PartsCheck::find_tree_error(const Parts& parts, int bodies) {
  const int entries = static_cast<int>(parts.part_of_body.size());
  if (entries != bodies)
    return "part_of_body has " + std::to_string(entries) + " entries, needs one per body";
  if (parts.parent_of_part.empty()) return {};
  std::string error = find_parent_error(parts.parent_of_part);
  if (!error.empty()) return error;
  int leaves = 0;
  while (leaves < static_cast<int>(has_child_.size()) && !has_child_[leaves]) ++leaves;
  return find_id_error(parts.part_of_body, leaves, ", a leaf");
}

std::string PartsCheck::find_error(const Parts& parts, int bodies) {
  const std::string error = find_tree_error(parts, bodies);
  if (!error.empty() || !parts.parent_of_part.empty()) return error;
  return find_id_error(parts.part_of_body, bodies, "");
}

}  // namespace cleave
