#include "solver/block_cholesky.h"

#include <algorithm>
#include <cassert>

#include "solver/linear/dense_block.h"

namespace cleave {

bool BlockCholesky::analyze(int node_count, std::span<const std::pair<int, int>> edges,
                            std::span<const int> stage_of_node, int stage_count, long most_blocks) {
  if (!symbolic_.analyze(node_count, edges, stage_of_node, stage_count, most_blocks)) return false;
  scratch_offset_.assign(1, 0);
  for (const Branch& branch : symbolic_.branches())
    scratch_offset_.push_back(scratch_offset_.back() + 6L * branch.most_rows_below);
  return true;
}

void BlockCholesky::count(MemoryCount& memory) const {
  symbolic_.count(memory);
  memory.add_grown(scratch_offset_);
  for (const long size :
       {symbolic_.factor_size(), symbolic_.update_size(), symbolic_.carry_size(), scratch_offset_.back()})
    memory.add<double>(size);
}

void BlockCholesky::allocate() {
  const auto make_room = [](std::vector<double>& array, long size) {
    free_if_short(array, size);
    array.resize(size);
  };
  make_room(panels_, symbolic_.factor_size());
  make_room(updates_, symbolic_.update_size());
  make_room(carry_, symbolic_.carry_size());
  make_room(scratch_, scratch_offset_.back());
}

// Its place among the rows of the supernode of its column; -1 outside the pattern.
int BlockCholesky::row_of_block(int first_node, int second_node) const {
  const int p = symbolic_.position_of_node()[first_node], q = symbolic_.position_of_node()[second_node];
  const int column = std::min(p, q), row = std::max(p, q);
  const Supernode& s = symbolic_.supernodes()[symbolic_.supernode_at_position()[column]];
  if (row < s.first_position + s.width) return row - s.first_position;  // own columns are the first rows
  const auto begin = symbolic_.rows().begin() + s.first_row, end = begin + s.row_count;
  const auto found = std::lower_bound(begin, end, row);
  return found != end && *found == row ? static_cast<int>(found - begin) : -1;
}

BlockCholesky::Place BlockCholesky::place(int first_node, int second_node) const {
  const int p = symbolic_.position_of_node()[first_node], q = symbolic_.position_of_node()[second_node];
  const int column = std::min(p, q), row = row_of_block(first_node, second_node);
  assert(row >= 0);
  const Supernode& s = symbolic_.supernodes()[symbolic_.supernode_at_position()[column]];
  Place place;
  place.leading_dimension = 6 * s.row_count;
  place.offset = s.panel_offset + 6L * row + 6L * (column - s.first_position) * place.leading_dimension;
  place.transposed = q < p;
  return place;
}

void BlockCholesky::set_zero(int branch_index) {
  const Branch& branch = symbolic_.branches()[branch_index];
  const Supernode& end = symbolic_.supernodes()[branch.last];
  std::fill(panels_.begin() + symbolic_.supernodes()[branch.first].panel_offset,
            panels_.begin() + end.panel_offset + 36L * end.width * end.row_count, 0.0);
}

// Adds the child's update matrix (lower triangle of blocks) into a range of the parent's panel and update
// matrix. Runs of rows that are adjacent in the parent too are added in one go.
void BlockCholesky::add_update(const Supernode& child, const Supernode& parent, const Range& range) {
  const int* target = symbolic_.row_in_parent().data() + child.first_row + child.width;
  const int count = child.rows_below(), ld = 6 * count;
  const auto place_of = [&](int row) {
    return static_cast<int>(std::lower_bound(target, target + count, row) - target);
  };
  const int first_row = place_of(range.first_row), last_row = place_of(range.last_row);
  const int last_column = place_of(range.last_column);
  const double* update = updates_.data() + child.update_offset;
  for (int column = place_of(range.first_column); column < last_column; ++column) {
    const int to = target[column];
    const bool in_panel = to < parent.width;
    const int to_ld = in_panel ? 6 * parent.row_count : 6 * parent.rows_below();
    const int shift = in_panel ? 0 : parent.width;
    double* block = in_panel ? panels_.data() + parent.panel_offset : updates_.data() + parent.update_offset;
    block += 6L * (to - shift) * to_ld;
    for (int row = std::max(first_row, column); row < last_row;) {
      int end = row + 1;
      while (end < last_row && target[end] == target[end - 1] + 1) ++end;
      add_columns(6 * (end - row), 6, update + 6L * column * ld + 6 * row, ld,
                  block + 6 * (target[row] - shift), to_ld);
      row = end;
    }
  }
}

void BlockCholesky::add_updates(int supernode, const Range& range) {
  const Supernode& s = symbolic_.supernodes()[supernode];
  for (int child : symbolic_.children(supernode)) add_update(symbolic_.supernodes()[child], s, range);
}

void BlockCholesky::gather(int supernode, int column_strip) {
  const Supernode& s = symbolic_.supernodes()[supernode];
  const FrontStrips strips(s);
  add_updates(supernode, {0, s.row_count, strips.begin(column_strip), strips.end(column_strip)});
}

void BlockCholesky::make_update(int supernode, int row_strip, int column_strip) {
  const Supernode& s = symbolic_.supernodes()[supernode];
  const FrontStrips strips(s);
  const Range range{strips.begin(row_strip), strips.end(row_strip), strips.begin(column_strip),
                    strips.end(column_strip)};
  const long ld = 6 * s.rows_below();
  double* tile = updates_.data() + s.update_offset + 6L * (range.first_row - s.width);
  for (long c = 6L * (range.first_column - s.width); c < 6L * (range.last_column - s.width); ++c)
    std::fill_n(tile + c * ld, 6 * (range.last_row - range.first_row), 0.0);
  add_updates(supernode, range);
  front(supernode).subtract_panel_product(row_strip, column_strip);
}

FrontTiles BlockCholesky::front(int supernode) {
  const Supernode& s = symbolic_.supernodes()[supernode];
  return {s, panels_.data() + s.panel_offset, updates_.data() + s.update_offset};
}

// Of its own columns: -L21 L21^T, the lower triangle of blocks; nobody looks at the rest.
void BlockCholesky::begin_update(const Supernode& s) {
  const int ld = 6 * s.row_count, below = s.rows_below(), update_ld = 6 * below;
  const double* rows = panel(s) + 6 * s.width;
  double* update = updates_.data() + s.update_offset;
  for (int k = 0; k < below; ++k) {
    write_negative_product(update_ld - 6 * k, 6 * s.width, rows + 6 * k, ld, rows + 6 * k, ld,
                           update + 6 * k + 6L * k * update_ld, update_ld);
  }
}

bool BlockCholesky::factor(int branch_index) {
  const Branch& branch = symbolic_.branches()[branch_index];
  for (int i = branch.first; i <= branch.last; ++i) {
    const Supernode& s = symbolic_.supernodes()[i];
    add_updates(i, {0, s.row_count, 0, s.width});
    if (!eliminate_columns(s.row_count, s.width, panels_.data() + s.panel_offset, 6 * s.row_count))
      return false;
    begin_update(s);
    add_updates(i, {s.width, s.row_count, s.width, s.row_count});
  }
  return true;
}

}  // namespace cleave
