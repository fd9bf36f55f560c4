#include "solver/block_matrix.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "solver/linear/dense_block.h"

namespace cleave {
namespace {

// target += the 6x6 block at `gram` (ld 12), or its transpose.
void add_block(double* target, int ld, const double* gram, bool transposed) {
  for (int c = 0; c < 6; ++c) {
    for (int r = 0; r < 6; ++r) target[r + c * ld] += transposed ? gram[c + 12 * r] : gram[r + 12 * c];
  }
}

}  // namespace

void BlockMatrix::analyze(const PreparedStep& step, std::span<const int> bodies,
                          std::span<const int> local_of_body, std::span<const int> groups,
                          std::span<const int> stage_of_local, int stage_count) {
  bodies_.assign(bodies.begin(), bodies.end());
  stage_of_local_.assign(bodies.size(), 0);
  if (!stage_of_local.empty()) stage_of_local_.assign(stage_of_local.begin(), stage_of_local.end());
  list_edges(step, local_of_body, groups);
  cholesky_.analyze(static_cast<int>(bodies.size()), edges_, stage_of_local, stage_count);
  sort_by_stage(stage_of_local_, stage_local_first_, stage_locals_);
  place_groups(step, local_of_body, groups);
}

bool BlockMatrix::rebind(const PreparedStep& step, std::span<const int> local_of_body,
                         std::span<const int> groups) {
  list_edges(step, local_of_body, groups);
  for (const auto& [a, b] : edges_) {
    if (!cholesky_.holds(a, b)) return false;
  }
  place_groups(step, local_of_body, groups);
  return true;
}

void BlockMatrix::number(const PreparedStep& step) {
  identity_.resize(std::max<std::size_t>(step.body_count(), step.groups().size()));
  std::iota(identity_.begin(), identity_.end(), 0);
}

void BlockMatrix::analyze_whole(const PreparedStep& step, std::span<const int> stage_of_body,
                                int stage_count) {
  number(step);
  const std::span<const int> all(identity_), bodies = all.first(step.body_count());
  analyze(step, bodies, bodies, all.first(step.groups().size()), stage_of_body, stage_count);
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

// Counting sort, stable: items of stage s at first[s] .. first[s + 1].
void BlockMatrix::sort_by_stage(std::span<const int> stage_of_item, std::vector<int>& first,
                                std::vector<int>& items) const {
  const int stage_count = cholesky_.symbolic().stage_count();
  first.assign(stage_count + 1, 0);
  items.resize(stage_of_item.size());
  for (int stage : stage_of_item) ++first[stage];
  for (int stage = 0, begin = 0; stage <= stage_count; ++stage) begin += std::exchange(first[stage], begin);
  for (std::size_t i = 0; i < stage_of_item.size(); ++i)
    items[first[stage_of_item[i]]++] = static_cast<int>(i);
  for (int stage = stage_count; stage > 0; --stage) first[stage] = first[stage - 1];
  first[0] = 0;
}

void BlockMatrix::place_groups(const PreparedStep& step, std::span<const int> local_of_body,
                               std::span<const int> groups) {
  step_ = &step;
  const auto stages_of = [&](int g) {
    const RowGroup& group = step.groups()[g];
    const int stage_a = stage_of_local_[local_of_body[group.body_a]];
    return std::pair(stage_a, group.body_b < 0 ? stage_a : stage_of_local_[local_of_body[group.body_b]]);
  };
  group_stage_.clear();
  for (int g : groups) group_stage_.push_back(std::min(stages_of(g).first, stages_of(g).second));
  sort_by_stage(group_stage_, entry_first_, group_order_);
  entries_.clear();
  late_entries_.clear();
  for (int place : group_order_) {
    const RowGroup& group = step.groups()[groups[place]];
    const int a = local_of_body[group.body_a], b = group.body_b < 0 ? -1 : local_of_body[group.body_b];
    Entry entry;
    entry.group = groups[place];
    std::tie(entry.stage_a, entry.stage_b) = stages_of(entry.group);
    entry.a = cholesky_.place(a, a);
    if (b >= 0) entry.b = cholesky_.place(b, b), entry.ab = cholesky_.place(a, b);
    if (b < 0) entry.stage_b = -1;
    if (b >= 0 && entry.stage_a != entry.stage_b) {
      entry.late = static_cast<int>(late_entries_.size());
      late_entries_.push_back(static_cast<int>(entries_.size()));
    }
    entries_.push_back(entry);
  }
  late_gram_.resize(144 * late_entries_.size());
  late_any_.resize(late_entries_.size());
}

void BlockMatrix::assemble(const WeightedRows& rows, int stage) {
  cholesky_.set_zero(stage);
  double* panels = cholesky_.panels();
  for (int k = stage_local_first_[stage]; k < stage_local_first_[stage + 1]; ++k) {
    const int local = stage_locals_[k];
    const BlockCholesky::Place place = cholesky_.place(local, local);
    const double* mass = step_->problem().mass.data() + 36 * bodies_[local];
    for (int c = 0; c < 6; ++c) {
      for (int r = 0; r < 6; ++r) panels[place.offset + r + c * place.leading_dimension] += mass[r + 6 * c];
    }
  }
  const double *jacobian = rows.jacobian(), *d = rows.d().data();
  double local[144];
  for (int i = entry_first_[stage]; i < entry_first_[stage + 1]; ++i) {
    const Entry& entry = entries_[i];
    const RowGroup& group = step_->groups()[entry.group];
    double* gram = entry.late < 0 ? local : late_gram_.data() + 144 * entry.late;
    const bool any =
        weighted_gram(group.row_count, jacobian + 12 * group.first_row, d + group.first_row, gram);
    if (entry.late >= 0) late_any_[entry.late] = any;
    if (!any) continue;
    if (entry.stage_a == stage) add_block(panels + entry.a.offset, entry.a.leading_dimension, gram, false);
    if (entry.stage_b < 0) continue;
    if (entry.stage_b == stage)
      add_block(panels + entry.b.offset, entry.b.leading_dimension, gram + 78, false);
    add_block(panels + entry.ab.offset, entry.ab.leading_dimension, gram + 6, entry.ab.transposed);
  }
  if (stage + 1 < cholesky_.symbolic().stage_count()) return;
  for (int i : late_entries_) {
    const Entry& entry = entries_[i];
    const bool a_is_late = entry.stage_a > entry.stage_b;
    if (!late_any_[entry.late]) continue;
    const BlockCholesky::Place& place = a_is_late ? entry.a : entry.b;
    add_block(panels + place.offset, place.leading_dimension,
              late_gram_.data() + 144 * entry.late + (a_is_late ? 0 : 78), false);
  }
}

}  // namespace cleave
