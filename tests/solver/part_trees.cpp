#include "tests/solver/part_trees.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

constexpr int kMostChildren = 5;

void shuffle(SeededRandom& random, std::vector<int>& values) {
  for (int i = static_cast<int>(values.size()) - 1; i > 0; --i)
    std::swap(values[i], values[random.integer(0, i)]);
}

std::vector<int> leaf_numbers(int leaves) {
  std::vector<int> numbers(leaves);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

}  // namespace

PartTree sliced_tree(int bodies, int leaves) {
  PartTree tree{sliced_parts(bodies, leaves), std::vector<int>(leaves, -1)};
  std::vector<int> level = leaf_numbers(leaves);
  while (level.size() > 1) {
    std::vector<int> up;
    for (std::size_t i = 0; i < level.size(); i += 2) {
      if (i + 1 == level.size()) {
        up.push_back(level[i]);
        continue;
      }
      const int node = static_cast<int>(tree.parent_of_part.size());
      tree.parent_of_part[level[i]] = tree.parent_of_part[level[i + 1]] = node;
      tree.parent_of_part.push_back(-1);
      up.push_back(node);
    }
    level = up;
  }
  return tree;
}

PartTree random_tree(SeededRandom& random, int bodies, int leaves) {
  std::vector<int> open = leaf_numbers(leaves);  // nodes that have no parent yet
  shuffle(random, open);
  const int with_bodies = random.integer(1, std::min(leaves, bodies));
  PartTree tree{random_parts(random, bodies, with_bodies), std::vector<int>(leaves, -1)};
  for (int& part : tree.part_of_body) part = open[part];
  while (open.size() > 1) {
    shuffle(random, open);
    const int node = static_cast<int>(tree.parent_of_part.size());
    const int children = random.integer(2, std::min(kMostChildren, static_cast<int>(open.size())));
    for (int k = 0; k < children; ++k) {
      tree.parent_of_part[open.back()] = node;
      open.pop_back();
    }
    tree.parent_of_part.push_back(-1);
    open.push_back(node);
  }
  return tree;
}

}  // namespace cleave
