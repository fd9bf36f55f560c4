#include "solver/block_matrix.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "solver/counting_sort.h"
#include "solver/linear/dense_block.h"
#include "solver/linear/vector_lanes.h"

namespace cleave {
namespace {

// target += the 6x6 block, or its transpose. Two numbers at a time: the second body's have only just been
// stored, four or eight at a time, and a load that is not within one of those stores would wait for memory.
void add_block(double* target, int ld, const double* block, int block_ld, bool transposed) {
  for (int c = 0; c < 6; ++c) {
    for (int r = 0; r < 6; r += 2) {
      const double* from = block + r + block_ld * c;
      const Vector<2> pair =
          transposed ? Vector<2>{block[c + block_ld * r], block[c + block_ld * (r + 1)]} : load<2>(from);
      double* into = target + r + c * ld;
      store<2>(into, load<2>(into) + pair);
    }
  }
}

constexpr std::uint64_t kBlockBytes = 36 * sizeof(double);

// A block of a 12x12 Gram matrix, out of it.
void copy_block(const double* gram, double* block) {
  for (int c = 0; c < 6; ++c) std::copy_n(gram + 12 * c, 6, block + 6 * c);
}

void sort_by_branch(std::span<const int> branch_of_item, int branches, std::vector<int>& first,
                    std::vector<int>& items) {
  sort_into_buckets(
      static_cast<int>(branch_of_item.size()), branches, [&](int item) { return branch_of_item[item]; },
      first, items);
}

}  // namespace

bool BlockMatrix::analyze(const PreparedStep& step, std::span<const int> bodies,
                          std::span<const int> local_of_body, std::span<const int> groups,
                          std::span<const int> stage_of_local, int stage_count, long most_blocks) {
  bodies_.assign(bodies.begin(), bodies.end());
  list_edges(step, local_of_body, groups);
  analyzed_ =
      cholesky_.analyze(static_cast<int>(bodies.size()), edges_, stage_of_local, stage_count, most_blocks);
  if (!analyzed_) return false;
  place_bodies();
  list_entries(step, local_of_body, groups);
  return true;
}

long BlockMatrix::most_blocks(std::uint64_t limit_bytes) {
  return static_cast<long>(limit_bytes / kBlockBytes);
}

void BlockMatrix::count(MemoryCount& memory) const {
  if (!analyzed_) return memory.add<double>(36, cholesky_.symbolic().block_count());
  cholesky_.count(memory);
  memory.add_grown(bodies_, local_branch_, branch_local_first_, branch_locals_, identity_, entries_,
                   entry_first_, late_places_, late_branch_, late_first_, late_slots_, group_branch_,
                   group_order_, edges_, is_placed_);
  memory.add<double>(36, late_places_.size());
  memory.add<char>(late_places_.size());
}

void BlockMatrix::allocate() {
  cholesky_.allocate();
  free_if_short(late_blocks_, 36 * late_places_.size());
  late_blocks_.resize(36 * late_places_.size());
  late_any_.resize(late_places_.size());
}

bool BlockMatrix::rebind(const PreparedStep& step, std::span<const int> local_of_body,
                         std::span<const int> groups) {
  list_edges(step, local_of_body, groups);
  for (const auto& [a, b] : edges_) {
    if (!cholesky_.holds(a, b)) return false;
  }
  list_entries(step, local_of_body, groups);
  return true;
}

void BlockMatrix::number(const PreparedStep& step) {
  identity_.resize(std::max<std::size_t>(step.body_count(), step.groups().size()));
  std::iota(identity_.begin(), identity_.end(), 0);
}

bool BlockMatrix::analyze_whole(const PreparedStep& step, std::span<const int> stage_of_body, int stage_count,
                                long most_blocks) {
  number(step);
  const std::span<const int> all(identity_), bodies = all.first(step.body_count());
  return analyze(step, bodies, bodies, all.first(step.groups().size()), stage_of_body, stage_count,
                 most_blocks);
}

bool BlockMatrix::rebind_whole(const PreparedStep& step) {
  number(step);
  const std::span<const int> all(identity_);
  return rebind(step, all.first(step.body_count()), all.first(step.groups().size()));
}

void BlockMatrix::list_edges(const PreparedStep& step, std::span<const int> local_of_body,
                             std::span<const int> groups) {
  edges_.clear();
  for (int g : groups) {
    const RowGroup& group = step.groups()[g];
    if (group.body_b >= 0) edges_.emplace_back(local_of_body[group.body_a], local_of_body[group.body_b]);
  }
}

void BlockMatrix::place_bodies() {
  const BlockSymbolic& symbolic = cholesky_.symbolic();
  local_branch_.clear();
  for (std::size_t local = 0; local < bodies_.size(); ++local) {
    const int supernode = symbolic.supernode_at_position()[symbolic.position_of_node()[local]];
    local_branch_.push_back(symbolic.supernodes()[supernode].branch);
  }
  sort_by_branch(local_branch_, branch_count(), branch_local_first_, branch_locals_);
}

// By the branch that is eliminated first: branches are numbered in that order.
void BlockMatrix::sort_groups(const PreparedStep& step, std::span<const int> local_of_body,
                              std::span<const int> groups) {
  group_branch_.clear();
  for (const int g : groups) {
    const RowGroup& group = step.groups()[g];
    const int branch_a = local_branch_[local_of_body[group.body_a]];
    group_branch_.push_back(
        group.body_b < 0 ? branch_a : std::min(branch_a, local_branch_[local_of_body[group.body_b]]));
  }
  sort_by_branch(group_branch_, branch_count(), entry_first_, group_order_);
}

void BlockMatrix::list_entries(const PreparedStep& step, std::span<const int> local_of_body,
                               std::span<const int> groups) {
  step_ = &step;
  sort_groups(step, local_of_body, groups);
  is_placed_.assign(branch_count(), 0);
  entries_.resize(groups.size());
  late_branch_.clear();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const RowGroup& group = step.groups()[groups[group_order_[i]]];
    Entry& entry = entries_[i] = {};
    entry.group = groups[group_order_[i]];
    entry.a.local = local_of_body[group.body_a];
    if (group.body_b < 0) continue;
    entry.b.local = local_of_body[group.body_b];
    const int branch_a = local_branch_[entry.a.local], branch_b = local_branch_[entry.b.local];
    if (branch_a == branch_b) continue;
    (branch_a > branch_b ? entry.a : entry.b).is_late = true;
    entry.late = static_cast<int>(late_branch_.size());
    late_branch_.push_back(std::max(branch_a, branch_b));
  }
  late_places_.resize(late_branch_.size());
  sort_by_branch(late_branch_, branch_count(), late_first_, late_slots_);
}

// By whoever assembles the branch first.
void BlockMatrix::place_entries(int branch) {
  for (int i = entry_first_[branch]; i < entry_first_[branch + 1]; ++i) {
    Entry& entry = entries_[i];
    entry.a.place = cholesky_.place(entry.a.local, entry.a.local);
    if (!entry.has_b()) continue;
    entry.b.place = cholesky_.place(entry.b.local, entry.b.local);
    entry.ab = cholesky_.place(entry.a.local, entry.b.local);
    if (entry.late >= 0) late_places_[entry.late] = entry.a.is_late ? entry.a.place : entry.b.place;
  }
  is_placed_[branch] = 1;
}

// Of one group of rows, whose bodies' blocks go to their places or are kept for later.
void BlockMatrix::add_entry(const Entry& entry, const WeightedRows& rows) {
  const RowGroup& group = step_->groups()[entry.group];
  double* panels = cholesky_.panels();
  double gram[144];
  const bool any =
      weighted_gram(entry.has_b() ? 2 : 1, group.row_count, rows.jacobian() + 12L * group.first_row,
                    rows.d().data() + group.first_row, gram);
  if (entry.late >= 0) late_any_[entry.late] = any;
  if (!any) return;
  const auto add = [&](const BlockCholesky::Place& place, const double* block) {
    add_block(panels + place.offset, place.leading_dimension, block, 12, place.transposed);
  };
  if (!entry.a.is_late) add(entry.a.place, gram);
  if (!entry.has_b()) return;
  if (!entry.b.is_late) add(entry.b.place, gram + 78);
  add(entry.ab, gram + 6);
  if (entry.late >= 0) copy_block(gram + (entry.a.is_late ? 0 : 78), late_blocks_.data() + 36L * entry.late);
}

void BlockMatrix::assemble(const WeightedRows& rows, int branch) {
  cholesky_.set_zero(branch);
  double* panels = cholesky_.panels();
  for (int k = branch_local_first_[branch]; k < branch_local_first_[branch + 1]; ++k) {
    const int local = branch_locals_[k];
    const BlockCholesky::Place place = cholesky_.place(local, local);
    const double* mass = step_->problem().mass.data() + 36L * bodies_[local];
    add_block(panels + place.offset, place.leading_dimension, mass, 6, false);
  }
  if (!is_placed_[branch]) place_entries(branch);
  for (int i = entry_first_[branch]; i < entry_first_[branch + 1]; ++i) add_entry(entries_[i], rows);
}

void BlockMatrix::add_late(int slot) {
  if (!late_any_[slot]) return;
  const BlockCholesky::Place& place = late_places_[slot];
  add_block(cholesky_.panels() + place.offset, place.leading_dimension, late_blocks_.data() + 36L * slot, 6,
            false);
}

bool BlockMatrix::factor(int branch) {
  for (int k = late_first_[branch]; k < late_first_[branch + 1]; ++k) add_late(late_slots_[k]);
  return cholesky_.factor(branch);
}

void BlockMatrix::gather(int branch, int column_strip) {
  const int supernode = cholesky_.symbolic().branches()[branch].last;
  const Supernode& s = cholesky_.symbolic().supernodes()[supernode];
  const FrontStrips strips(s);
  for (int k = late_first_[branch]; k < late_first_[branch + 1]; ++k) {
    const BlockCholesky::Place& place = late_places_[late_slots_[k]];
    const long column = (place.offset - s.panel_offset) / (6L * place.leading_dimension);
    if (column >= strips.begin(column_strip) && column < strips.end(column_strip)) add_late(late_slots_[k]);
  }
  cholesky_.gather(supernode, column_strip);
}

void BlockMatrix::assemble(const WeightedRows& rows) {
  for (int branch = 0; branch < branch_count(); ++branch) assemble(rows, branch);
}

bool BlockMatrix::factor() {
  for (int branch = 0; branch < branch_count(); ++branch) {
    if (!factor(branch)) return false;
  }
  return true;
}

}  // namespace cleave
