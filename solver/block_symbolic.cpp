#include "solver/block_symbolic.h"

#include <camd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <new>
#include <numeric>

#include "solver/counting_sort.h"

namespace cleave {
namespace {

// Blocks of a dense trapezoid of `width` columns, the first with `rows` rows.
long trapezoid_blocks(long width, long rows) { return width * rows - width * (width - 1) / 2; }

// Joining two supernodes trades padding (zeros that are computed with) for longer dense loops. Allowed share
// of padding by width in blocks: narrow supernodes are dominated by overhead, wide ones by arithmetic.
double allowed_padding(int width) { return width <= 2 ? 0.6 : width <= 4 ? 0.35 : width <= 8 ? 0.15 : 0.05; }

double flops_of(const Supernode& s) { return 216.0 * s.width * s.row_count * s.row_count; }

// A branch has at most this share of all work, so that 16 workers have several each, but is not smaller than what takes
// about ten microseconds.
constexpr double kMostBranchShare = 1.0 / 64;
constexpr double kLeastBranchFlops = 1e5;

}  // namespace

bool BlockSymbolic::analyze(int node_count, std::span<const std::pair<int, int>> edges,
                            std::span<const int> stage_of_node, int stage_count, long most_blocks) {
  node_count_ = node_count;
  build_adjacency(edges);
  order(stage_of_node);
  find_elimination_tree();
  postorder();
  find_elimination_tree();
  if (!find_structures(most_blocks)) return false;
  find_supernodes(stage_of_node, stage_count);
  list_rows();
  find_branches();
  list_branch_children();
  list_carries();
  place_storage();
  return true;
}

void BlockSymbolic::count(MemoryCount& memory) const {
  memory.add_grown(adjacency_first_, adjacency_, position_of_node_, node_at_position_, parent_, column_first_,
                   column_rows_, supernodes_, supernode_at_position_, rows_, row_in_parent_, branches_);
  memory.add_grown(branch_child_first_, branch_children_, carry_index_, child_first_, children_, stage_flops_,
                   mark_, head_, next_, stack_, true_blocks_, subtree_flops_);
}

void BlockSymbolic::build_adjacency(std::span<const std::pair<int, int>> edges) {
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

void BlockSymbolic::order(std::span<const int> stage_of_node) {
  position_of_node_.resize(node_count_);
  node_at_position_.resize(node_count_);
  if (node_count_ == 0) return;
  // The ordering wants constraint sets below node_count, so the stages in use are numbered anew, in their
  // order.
  int* constraint = nullptr;
  if (!stage_of_node.empty()) {
    stack_.assign(stage_of_node.begin(), stage_of_node.end());
    std::sort(stack_.begin(), stack_.end());
    stack_.erase(std::unique(stack_.begin(), stack_.end()), stack_.end());
    mark_.resize(node_count_);
    for (int node = 0; node < node_count_; ++node) {
      mark_[node] = static_cast<int>(std::ranges::lower_bound(stack_, stage_of_node[node]) - stack_.begin());
    }
    constraint = mark_.data();
  }
  const int status = camd_order(node_count_, adjacency_first_.data(), adjacency_.data(),
                                node_at_position_.data(), nullptr, nullptr, constraint);
  if (status == CAMD_OUT_OF_MEMORY) throw std::bad_alloc();
  assert(status == CAMD_OK);
  for (int p = 0; p < node_count_; ++p) position_of_node_[node_at_position_[p]] = p;
}

// Liu's algorithm: every earlier neighbour climbs to its present root, which becomes a child of this column.
void BlockSymbolic::find_elimination_tree() {
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
void BlockSymbolic::postorder() {
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
}

// Structure of a column = its later neighbours and the structures of its children, less itself.
bool BlockSymbolic::find_structures(long most_blocks) {
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

void BlockSymbolic::find_supernodes(std::span<const int> stage_of_node, int stage_count) {
  supernodes_.clear();
  true_blocks_.clear();
  stage_flops_.assign(stage_count, 0.0);
  for (int p = 0; p < node_count_; ++p) {
    const int below = static_cast<int>(column_first_[p + 1] - column_first_[p]);
    Supernode s;
    s.stage = stage_of_node.empty() ? 0 : stage_of_node[node_at_position_[p]];
    s.first_position = p;
    s.width = 1;
    s.row_count = below + 1;
    long blocks = below + 1;
    for (int k = 1; k <= 6; ++k) stage_flops_[s.stage] += (6.0 * below + k) * (6.0 * below + k);
    // Take in the supernode just before as long as it is a child and the padding stays small.
    while (!supernodes_.empty()) {
      const Supernode& child = supernodes_.back();
      const int child_last = s.first_position - 1;
      if (child.stage != s.stage || parent_[child_last] < 0 || parent_[child_last] > p) break;
      const int width = child.width + s.width, rows = child.width + s.row_count;
      const long dense = trapezoid_blocks(width, rows), filled = true_blocks_.back() + blocks;
      if (static_cast<double>(dense - filled) > allowed_padding(width) * static_cast<double>(dense)) break;
      s.first_position = child.first_position;
      s.width = width;
      s.row_count = rows;
      blocks = filled;
      supernodes_.pop_back();
      true_blocks_.pop_back();
    }
    supernodes_.push_back(s);
    true_blocks_.push_back(blocks);
  }
}

void BlockSymbolic::list_rows() {
  const int count = static_cast<int>(supernodes_.size());
  supernode_at_position_.resize(node_count_);
  rows_.clear();
  for (int i = 0; i < count; ++i) {
    Supernode& s = supernodes_[i];
    s.first_row = static_cast<long>(rows_.size());
    const int last = s.first_position + s.width - 1;
    for (int p = s.first_position; p <= last; ++p) rows_.push_back(p), supernode_at_position_[p] = i;
    rows_.insert(rows_.end(), column_rows_.begin() + column_first_[last],
                 column_rows_.begin() + column_first_[last + 1]);
    s.row_count = static_cast<int>(static_cast<long>(rows_.size()) - s.first_row);
  }
  row_in_parent_.assign(rows_.size(), -1);
  for (int i = 0; i < count; ++i) {
    Supernode& s = supernodes_[i];
    s.first_descendant = i;
    if (s.rows_below() == 0) continue;
    s.parent = supernode_at_position_[rows_[s.first_row + s.width]];
    const Supernode& up = supernodes_[s.parent];
    for (int k = s.width, q = 0; k < s.row_count; ++k) {
      while (rows_[up.first_row + q] != rows_[s.first_row + k]) ++q;
      row_in_parent_[s.first_row + k] = q;
    }
  }
  sort_into_buckets(
      count, count, [this](int i) { return supernodes_[i].parent; }, child_first_, children_);
  for (int i = 0; i < count; ++i) {
    for (int child : children(i)) {
      supernodes_[i].first_descendant =
          std::min(supernodes_[i].first_descendant, supernodes_[child].first_descendant);
    }
  }
}

// A subtree is one branch where it is of one stage and has so little work that more workers than anybody has would
// still get enough of them; what is above goes supernode by supernode.
void BlockSymbolic::find_branches() {
  const int count = static_cast<int>(supernodes_.size());
  subtree_flops_.assign(count, 0.0);
  std::vector<int>& one_stage = mark_;
  one_stage.assign(count, 1);
  double total = 0;
  for (int i = 0; i < count; ++i) {
    const Supernode& s = supernodes_[i];
    const double flops = flops_of(s);
    total += flops;
    subtree_flops_[i] += flops;
    if (s.parent < 0) continue;
    subtree_flops_[s.parent] += subtree_flops_[i];
    if (!one_stage[i] || supernodes_[s.parent].stage != s.stage) one_stage[s.parent] = 0;
  }
  const double most = std::max(kLeastBranchFlops, kMostBranchShare * total);
  branches_.clear();
  for (int i = count - 1; i >= 0;) {
    const Supernode& s = supernodes_[i];
    Branch branch;
    branch.last = i;
    branch.first = one_stage[i] && subtree_flops_[i] <= most ? s.first_descendant : i;
    branch.stage = s.stage;
    branch.end_position = s.first_position + s.width;
    branches_.push_back(branch);
    i = branch.first - 1;
  }
  std::ranges::reverse(branches_);
  double before = 0;
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    Branch& branch = branches_[b];
    branch.place = std::min(before / std::max(total, 1.0), 1 - 1e-9);
    for (int i = branch.first; i <= branch.last; ++i) {
      before += flops_of(supernodes_[i]);
      supernodes_[i].branch = static_cast<int>(b);
      branch.most_rows_below = std::max(branch.most_rows_below, supernodes_[i].rows_below());
    }
  }
}

void BlockSymbolic::list_branch_children() {
  for (Branch& branch : branches_) {
    const int up = supernodes_[branch.last].parent;
    if (up >= 0) branch.parent = supernodes_[up].branch;
  }
  const int count = static_cast<int>(branches_.size());
  sort_into_buckets(
      count, count, [this](int branch) { return branches_[branch].parent; }, branch_child_first_,
      branch_children_);
}

// The rows of a supernode above its branch are among the rows below the branch's root, and both lists ascend.
void BlockSymbolic::list_carries() {
  carry_index_.assign(rows_.size(), -1);
  carry_size_ = 0;
  for (Branch& branch : branches_) {
    const Supernode& root = supernodes_[branch.last];
    const long below = root.first_row + root.width;
    branch.carry_offset = carry_size_;
    carry_size_ += 6L * root.rows_below();
    for (int i = branch.first; i <= branch.last; ++i) {
      const Supernode& s = supernodes_[i];
      int q = 0;
      for (long k = s.first_row + s.width; k < s.first_row + s.row_count; ++k) {
        if (rows_[k] < branch.end_position) continue;
        while (rows_[below + q] != rows_[k]) ++q;
        carry_index_[k] = q;
      }
    }
  }
}

// Update matrices live on two stacks per branch, by parity of the depth in the tree: when a supernode is
// eliminated in postorder, its children's updates are on top of the other stack, so both stacks stay
// last-in-first-out and the memory in use stays small and warm. The root's update stays for the parent branch.
void BlockSymbolic::place_storage() {
  const int count = static_cast<int>(supernodes_.size());
  std::vector<int>& depth = mark_;
  depth.assign(count, 0);
  for (int i = count - 1; i >= 0; --i) {
    if (supernodes_[i].parent >= 0) depth[i] = depth[supernodes_[i].parent] + 1;
  }
  factor_size_ = 0;
  update_size_ = 0;
  for (const Branch& branch : branches_) {
    std::array<long, 2> top{}, peak{};
    for (int i = branch.first; i <= branch.last; ++i) {
      Supernode& s = supernodes_[i];
      s.panel_offset = factor_size_;
      factor_size_ += 36L * s.width * s.row_count;
      for (int child : children(i)) {
        const Supernode& below = supernodes_[child];
        if (below.branch == s.branch) top[1 - depth[i] % 2] -= 36L * below.rows_below() * below.rows_below();
      }
      long& own = top[depth[i] % 2];
      s.update_offset = own;
      own += 36L * s.rows_below() * s.rows_below();
      peak[depth[i] % 2] = std::max(peak[depth[i] % 2], own);
    }
    for (int i = branch.first; i <= branch.last; ++i) {
      supernodes_[i].update_offset += update_size_ + (depth[i] % 2 == 1 ? peak[0] : 0);
    }
    update_size_ += peak[0] + peak[1];
  }
}

}  // namespace cleave
