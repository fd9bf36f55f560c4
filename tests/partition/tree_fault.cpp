#include "tests/partition/tree_fault.h"

#include <vector>

#include "tests/partition/brute_force.h"

namespace cleave::partition_test {
namespace {

std::vector<int> children_of(const std::vector<int>& parent_of_part, int node) {
  std::vector<int> children;
  for (int other = 0; other < static_cast<int>(parent_of_part.size()); ++other)
    if (parent_of_part[other] == node) children.push_back(other);
  return children;
}

// Nodes below and at `node`; -1 where a node has one child or a part no leaf, so that no walk is endless.
int count_below(const std::vector<int>& parent_of_part, int leaves, int node) {
  const std::vector<int> children = children_of(parent_of_part, node);
  if ((node < leaves) != children.empty() || children.size() == 1) return -1;
  int count = 1;
  for (const int child : children) {
    const int below = child < node ? count_below(parent_of_part, leaves, child) : -1;
    if (below < 0) return -1;
    count += below;
  }
  return count;
}

}  // namespace

std::string tree_fault(const Bodies& bodies, const Partition& nested) {
  if (const std::string fault = ids_fault(bodies, nested); !fault.empty()) return fault;
  const int nodes = static_cast<int>(nested.parent_of_part.size());
  if (bodies.count() == 0) return nodes == 0 ? "" : "nodes without a body";
  const std::vector<int> roots = children_of(nested.parent_of_part, -1);
  if (roots.size() != 1) return std::to_string(roots.size()) + " roots";
  const int below = count_below(nested.parent_of_part, nested.part_count, roots.front());
  if (below < 0) return "a node without the children it must have, or after its parent";
  return below == nodes ? "" : "nodes that hang from no root";
}

}  // namespace cleave::partition_test
