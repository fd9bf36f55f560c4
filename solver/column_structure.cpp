#include "solver/column_structure.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace cleave {
namespace {

// A dissection takes about as long as a factorisation of this size, and is used again while the pattern
// stays. Measured: piles and towers of up to 10 000 bodies have less fill by degree; a silo of 2000 has 0.75
// times as many flops by dissection.
constexpr double kLeastDissectedFlops = 2e8;

}  // namespace

bool ColumnStructure::analyze(int node_count, std::span<const std::pair<int, int>> edges,
                              std::span<const int> stage_of_node, long most_blocks) {
  node_count_ = node_count;
  build_adjacency(edges);
  position_of_node_.resize(node_count_);
  node_at_position_.resize(node_count_);
  order_by_degree(graph(), number_stages(stage_of_node), node_at_position_);
  const bool fits = find_columns(most_blocks);
  if (!stage_of_node.empty() || (fits && all_flops() <= kLeastDissectedFlops)) return fits;
  return choose_order(fits, most_blocks);
}

void ColumnStructure::count(MemoryCount& memory) const {
  memory.add_grown(adjacency_first_, adjacency_, position_of_node_, node_at_position_, parent_, column_first_,
                   column_rows_, mark_, head_, next_, stack_, order_by_degree_);
}

void ColumnStructure::build_adjacency(std::span<const std::pair<int, int>> edges) {
  adjacency_first_.assign(node_count_ + 1, 0);
  for (auto [a, b] : edges) ++adjacency_first_[a + 1], ++adjacency_first_[b + 1];
  std::partial_sum(adjacency_first_.begin(), adjacency_first_.end(), adjacency_first_.begin());
  adjacency_.resize(2 * edges.size());
  stack_.assign(adjacency_first_.begin(), adjacency_first_.end());
  for (auto [a, b] : edges) {
    adjacency_[stack_[a]++] = b;
    adjacency_[stack_[b]++] = a;
  }
  int kept = 0;
  for (int node = 0; node < node_count_; ++node) {
    const int first = adjacency_first_[node], last = adjacency_first_[node + 1];
    std::sort(adjacency_.begin() + first, adjacency_.begin() + last);
    adjacency_first_[node] = kept;
    for (int k = first; k < last; ++k) {
      if (k == first || adjacency_[k] != adjacency_[k - 1]) adjacency_[kept++] = adjacency_[k];
    }
  }
  adjacency_first_[node_count_] = kept;
  adjacency_.resize(kept);
  adjacency_.reserve(1);  // the ordering wants an address even where there is no edge
}

// The ordering wants constraint sets below node_count, so the stages in use are numbered anew, in their
// order.
std::span<const int> ColumnStructure::number_stages(std::span<const int> stage_of_node) {
  stack_.assign(stage_of_node.begin(), stage_of_node.end());
  std::sort(stack_.begin(), stack_.end());
  stack_.erase(std::unique(stack_.begin(), stack_.end()), stack_.end());
  mark_.clear();
  for (const int stage : stage_of_node)
    mark_.push_back(static_cast<int>(std::ranges::lower_bound(stack_, stage) - stack_.begin()));
  return mark_;
}

// What is below the diagonal, in the order of node_at_position_; False where it is more than most_blocks.
bool ColumnStructure::find_columns(long most_blocks) {
  for (int p = 0; p < node_count_; ++p) position_of_node_[node_at_position_[p]] = p;
  find_elimination_tree();
  postorder();
  return find_structures(most_blocks);
}

// The lesser of the present order, by degree, and nested dissection. fits: whether the present one has
// most_blocks at most.
bool ColumnStructure::choose_order(bool fits, long most_blocks) {
  const double flops = fits ? all_flops() : std::numeric_limits<double>::infinity();
  order_by_degree_ = node_at_position_;
  const bool dissected = order_by_dissection(graph(), node_at_position_);
  if (dissected && find_columns(most_blocks) && all_flops() < flops) return true;
  node_at_position_ = order_by_degree_;
  return find_columns(most_blocks);
}

double ColumnStructure::flops(int position) const {
  const double below = 6.0 * static_cast<double>(rows_below(position).size());
  return (6 * below + 42) * below + 91;  // the sum of (below + k)^2, k = 1 .. 6
}

double ColumnStructure::all_flops() const {
  double sum = 0;
  for (int p = 0; p < node_count_; ++p) sum += flops(p);
  return sum;
}

// Liu's algorithm: every earlier neighbour climbs to its present root, which becomes a child of this column.
void ColumnStructure::find_elimination_tree() {
  parent_.assign(node_count_, -1);
  std::vector<int>& ancestor = mark_;
  ancestor.assign(node_count_, -1);
  for (int p = 0; p < node_count_; ++p) {
    const int node = node_at_position_[p];
    for (int k = adjacency_first_[node]; k < adjacency_first_[node + 1]; ++k) {
      int q = position_of_node_[adjacency_[k]];
      while (q != -1 && q < p) {
        const int up = ancestor[q];
        ancestor[q] = p;
        if (up == -1) parent_[q] = p;
        q = up;
      }
    }
  }
}

// Renumbers so that every subtree is contiguous.
void ColumnStructure::postorder() {
  head_.assign(node_count_ + 1, -1);  // first child; roots hang below node_count_
  next_.assign(node_count_, -1);
  for (int p = node_count_ - 1; p >= 0; --p) {
    const int up = parent_[p] == -1 ? node_count_ : parent_[p];
    next_[p] = head_[up];
    head_[up] = p;
  }
  mark_.clear();  // the new order, as old positions
  for (int root = head_[node_count_]; root != -1; root = next_[root]) {
    stack_.assign(1, root);
    while (!stack_.empty()) {
      const int p = stack_.back();
      if (head_[p] == -1) {
        mark_.push_back(p);
        stack_.pop_back();
      } else {
        stack_.push_back(head_[p]);
        head_[p] = next_[head_[p]];
      }
    }
  }
  stack_.assign(node_at_position_.begin(), node_at_position_.end());
  for (int p = 0; p < node_count_; ++p) {
    node_at_position_[p] = stack_[mark_[p]];
    position_of_node_[node_at_position_[p]] = p;
  }
  next_.resize(node_count_);  // the new position of an old one
  for (int p = 0; p < node_count_; ++p) next_[mark_[p]] = p;
  stack_.assign(parent_.begin(), parent_.end());
  for (int p = 0; p < node_count_; ++p) {
    const int up = stack_[mark_[p]];
    parent_[p] = up == -1 ? -1 : next_[up];
  }
}

// Structure of a column = its later neighbours and the structures of its children, less itself.
bool ColumnStructure::find_structures(long most_blocks) {
  head_.assign(node_count_, -1);  // children lists
  next_.assign(node_count_, -1);
  for (int p = node_count_ - 1; p >= 0; --p) {
    if (parent_[p] != -1) {
      next_[p] = head_[parent_[p]];
      head_[parent_[p]] = p;
    }
  }
  mark_.assign(node_count_, -1);
  block_count_ = 0;
  column_first_.assign(node_count_ + 1, 0);
  column_rows_.clear();
  for (int p = 0; p < node_count_; ++p) {
    mark_[p] = p;
    const auto add = [&](int q) {
      if (q > p && mark_[q] != p) mark_[q] = p, column_rows_.push_back(q);
    };
    const int node = node_at_position_[p];
    for (int k = adjacency_first_[node]; k < adjacency_first_[node + 1]; ++k)
      add(position_of_node_[adjacency_[k]]);
    for (int child = head_[p]; child != -1; child = next_[child]) {
      for (long k = column_first_[child]; k < column_first_[child + 1]; ++k) add(column_rows_[k]);
    }
    std::sort(column_rows_.begin() + column_first_[p], column_rows_.end());
    column_first_[p + 1] = static_cast<long>(column_rows_.size());
    block_count_ = column_first_[p + 1] + p + 1;
    if (block_count_ > most_blocks) return false;
  }
  return true;
}

}  // namespace cleave
