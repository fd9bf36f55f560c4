#include "solver/block_symbolic.h"

#include <algorithm>
#include <array>

#include "solver/counting_sort.h"

namespace cleave {
namespace {

// Blocks of a dense trapezoid of `width` columns, the first with `rows` rows.
long trapezoid_blocks(long width, long rows) { return width * rows - width * (width - 1) / 2; }

// Joining two supernodes trades padding (zeros that are computed with) for longer dense loops. Allowed share
// of padding by width in blocks: narrow supernodes are dominated by overhead, wide ones by arithmetic.
double allowed_padding(int width) { return width <= 2 ? 0.6 : width <= 4 ? 0.35 : width <= 8 ? 0.15 : 0.05; }

// A branch has at most this share of all work, so that 16 workers have several each, but is not smaller than
// what takes about ten microseconds.
constexpr double kMostBranchShare = 1.0 / 64;
constexpr double kLeastBranchFlops = 1e5;

}  // namespace

bool BlockSymbolic::analyze(int node_count, std::span<const std::pair<int, int>> edges,
                            std::span<const int> stage_of_node, int stage_count, long most_blocks) {
  if (!columns_.analyze(node_count, edges, stage_of_node, most_blocks)) return false;
  find_supernodes(stage_of_node, stage_count);
  list_rows();
  find_branches();
  list_branch_children();
  list_carries();
  place_storage();
  return true;
}

void BlockSymbolic::count(MemoryCount& memory) const {
  columns_.count(memory);
  memory.add_grown(supernodes_, supernode_at_position_, rows_, row_in_parent_, branches_, branch_child_first_,
                   branch_children_, carry_index_, child_first_, children_, stage_flops_);
  memory.add_grown(mark_, true_blocks_, subtree_flops_);
}

void BlockSymbolic::find_supernodes(std::span<const int> stage_of_node, int stage_count) {
  supernodes_.clear();
  true_blocks_.clear();
  stage_flops_.assign(stage_count, 0.0);
  for (int p = 0; p < node_count(); ++p) {
    const int below = static_cast<int>(columns_.rows_below(p).size());
    Supernode s;
    s.stage = stage_of_node.empty() ? 0 : stage_of_node[node_at_position()[p]];
    s.first_position = p;
    s.width = 1;
    s.row_count = below + 1;
    long blocks = below + 1;
    stage_flops_[s.stage] += columns_.flops(p);
    // Take in the supernode just before as long as it is a child and the padding stays small.
    while (!supernodes_.empty()) {
      const Supernode& child = supernodes_.back();
      const int child_last = s.first_position - 1;
      if (child.stage != s.stage || columns_.parent(child_last) < 0 || columns_.parent(child_last) > p) break;
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
  supernode_at_position_.resize(node_count());
  rows_.clear();
  for (int i = 0; i < count; ++i) {
    Supernode& s = supernodes_[i];
    s.first_row = static_cast<long>(rows_.size());
    const int last = s.first_position + s.width - 1;
    for (int p = s.first_position; p <= last; ++p) rows_.push_back(p), supernode_at_position_[p] = i;
    const auto below = columns_.rows_below(last);
    rows_.insert(rows_.end(), below.begin(), below.end());
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

// A subtree is one branch where it is of one stage and has so little work that more workers than anybody has
// would still get enough of them; what is above goes supernode by supernode.
void BlockSymbolic::find_branches() {
  const int count = static_cast<int>(supernodes_.size());
  subtree_flops_.assign(count, 0.0);
  std::vector<int>& one_stage = mark_;
  one_stage.assign(count, 1);
  double total = 0;
  for (int i = 0; i < count; ++i) {
    const Supernode& s = supernodes_[i];
    const double flops = s.flops();
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
      before += supernodes_[i].flops();
      supernodes_[i].branch = static_cast<int>(b);
      for (int k = 0; k < supernodes_[i].width; ++k)
        branch.flops += columns_.flops(supernodes_[i].first_position + k);
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
// last-in-first-out and the memory in use stays small and warm. The root's update stays for the parent
// branch.
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
