#include "harness/world/overlapping_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cleave {
namespace {

constexpr int kMostBoxesOfALeaf = 4;

bool overlap(const AxisAlignedBox& a, const AxisAlignedBox& b) {
  return a[0] <= b[1] && b[0] <= a[1] && a[2] <= b[3] && b[2] <= a[3] && a[4] <= b[5] && b[4] <= a[5];
}

bool is_finite(const AxisAlignedBox& box) {
  return std::ranges::all_of(box, [](double x) { return std::isfinite(x); });
}

class BoxTree {
 public:
  using Pairs = std::vector<std::pair<int, int>>;

  // members: indices of finite boxes, put into the order of the leaves.
  BoxTree(std::span<const AxisAlignedBox> boxes, std::vector<int> members)
      : boxes_(boxes), members_(std::move(members)) {
    if (!members_.empty()) build(0, static_cast<int>(members_.size()));
  }

  void find_pairs(Pairs& pairs) const {
    if (!nodes_.empty()) find_within(0, pairs);
  }

  // Pairs of a box that is not in the tree with those that are.
  void find_pairs_with(int box, Pairs& pairs) const {
    if (!nodes_.empty()) find_with(box, 0, pairs);
  }

 private:
  struct Node {
    AxisAlignedBox bounds;  // of all its boxes
    int first, last;        // of members_
    int right = -1;         // second child; the first one is the next node; -1 for a leaf
    int size() const { return last - first; }
  };

  AxisAlignedBox bounds_of(int first, int last) const {
    AxisAlignedBox bounds = boxes_[members_[first]];
    for (int k = first + 1; k < last; ++k) {
      const AxisAlignedBox& box = boxes_[members_[k]];
      for (int axis = 0; axis < 3; ++axis) {
        bounds[2 * axis] = std::min(bounds[2 * axis], box[2 * axis]);
        bounds[2 * axis + 1] = std::max(bounds[2 * axis + 1], box[2 * axis + 1]);
      }
    }
    return bounds;
  }

  int build(int first, int last) {
    const int node = static_cast<int>(nodes_.size());
    nodes_.push_back({bounds_of(first, last), first, last});
    if (last - first <= kMostBoxesOfALeaf) return node;
    const AxisAlignedBox& bounds = nodes_[node].bounds;
    const auto side = [&](int axis) { return bounds[2 * axis + 1] - bounds[2 * axis]; };
    const int longest = side(0) >= std::max(side(1), side(2)) ? 0 : side(1) >= side(2) ? 1 : 2;
    const auto twice_middle = [&](int box) {
      return boxes_[box][2 * longest] + boxes_[box][2 * longest + 1];
    };
    const int middle = first + (last - first) / 2;
    std::nth_element(members_.begin() + first, members_.begin() + middle, members_.begin() + last,
                     [&](int a, int b) { return twice_middle(a) < twice_middle(b); });
    build(first, middle);
    const int right = build(middle, last);
    nodes_[node].right = right;
    return node;
  }

  void add_if_overlapping(int a, int b, Pairs& pairs) const {
    if (overlap(boxes_[a], boxes_[b])) pairs.emplace_back(std::minmax(a, b));
  }

  void find_within(int node, Pairs& pairs) const {
    const Node& own = nodes_[node];
    if (own.right >= 0) {
      find_within(node + 1, pairs);
      find_within(own.right, pairs);
      return find_between(node + 1, own.right, pairs);
    }
    for (int i = own.first; i < own.last; ++i)
      for (int j = i + 1; j < own.last; ++j) add_if_overlapping(members_[i], members_[j], pairs);
  }

  void find_between(int a, int b, Pairs& pairs) const {
    if (!overlap(nodes_[a].bounds, nodes_[b].bounds)) return;
    if (nodes_[a].size() < nodes_[b].size()) std::swap(a, b);
    if (nodes_[a].right >= 0) {
      find_between(a + 1, b, pairs);
      return find_between(nodes_[a].right, b, pairs);
    }
    for (int i = nodes_[a].first; i < nodes_[a].last; ++i)
      for (int j = nodes_[b].first; j < nodes_[b].last; ++j)
        add_if_overlapping(members_[i], members_[j], pairs);
  }

  void find_with(int box, int node, Pairs& pairs) const {
    if (!overlap(boxes_[box], nodes_[node].bounds)) return;
    if (nodes_[node].right >= 0) {
      find_with(box, node + 1, pairs);
      return find_with(box, nodes_[node].right, pairs);
    }
    for (int k = nodes_[node].first; k < nodes_[node].last; ++k) add_if_overlapping(box, members_[k], pairs);
  }

  std::span<const AxisAlignedBox> boxes_;
  std::vector<int> members_;
  std::vector<Node> nodes_;
};

}  // namespace

std::vector<std::pair<int, int>> overlapping_boxes(std::span<const AxisAlignedBox> boxes) {
  std::vector<int> finite, endless;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i)
    (is_finite(boxes[i]) ? finite : endless).push_back(i);
  std::vector<std::pair<int, int>> pairs;
  const BoxTree tree(boxes, std::move(finite));
  tree.find_pairs(pairs);
  for (std::size_t k = 0; k < endless.size(); ++k) {
    tree.find_pairs_with(endless[k], pairs);
    for (std::size_t other = 0; other < k; ++other)
      if (overlap(boxes[endless[k]], boxes[endless[other]])) pairs.emplace_back(endless[other], endless[k]);
  }
  return pairs;
}

}  // namespace cleave
