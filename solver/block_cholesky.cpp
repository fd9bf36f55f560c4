#include "solver/block_cholesky.h"

#include <algorithm>
#include <cassert>

#include "solver/linear/dense_block.h"
#include "solver/linear/vector_lanes.h"

namespace cleave {
namespace {

// Two numbers at a time: the compiler would call a function for six.
void copy_block(const double* from, double* to) {
  for (int c = 0; c < 6; c += 2) store<2>(to + c, load<2>(from + c));
}

void add_block(const double* from, double* to) {
  for (int c = 0; c < 6; c += 2) store<2>(to + c, load<2>(to + c) + load<2>(from + c));
}

}  // namespace

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

// Adds the child's update matrix (lower triangle of blocks) into a range of the parent's panel and update matrix. Runs
// of rows that are adjacent in the parent too are added in one go.
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
      const double* from = update + 6L * column * ld + 6 * row;
      double* into = block + 6 * (target[row] - shift);
      const int length = 6 * (end - row);
      for (int c = 0; c < 6; ++c, from += ld, into += to_ld) {
        for (int k = 0; k < length; ++k) into[k] += from[k];
      }
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

bool BlockCholesky::factor_panel(const Supernode& s) {
  const int ld = 6 * s.row_count;
  double* panel = panels_.data() + s.panel_offset;
  if (!eliminate_columns(s.row_count, s.width, panel, ld)) return false;
  const int below = s.rows_below(), update_ld = 6 * below;
  const double* rows = panel + 6 * s.width;
  double* update = updates_.data() + s.update_offset;
  for (int k = 0; k < below; ++k) {
    subtract_product(update_ld - 6 * k, 6 * s.width, rows + 6 * k, ld, rows + 6 * k, ld,
                     update + 6 * k + 6L * k * update_ld, update_ld);
  }
  return true;
}

bool BlockCholesky::factor(int branch_index) {
  const Branch& branch = symbolic_.branches()[branch_index];
  for (int i = branch.first; i <= branch.last; ++i) {
    const Supernode& s = symbolic_.supernodes()[i];
    std::fill_n(updates_.begin() + s.update_offset, 36L * s.rows_below() * s.rows_below(), 0.0);
    add_updates(i, {0, s.row_count, 0, s.row_count});
    if (!factor_panel(s)) return false;
  }
  return true;
}

// What the child branches left, then column by column; what goes above the branch is left to its parent.
void BlockCholesky::forward(int branch_index, double* x) {
  const Branch& branch = symbolic_.branches()[branch_index];
  const auto supernodes = symbolic_.supernodes();
  const int *rows = symbolic_.rows().data(), *carry_index = symbolic_.carry_index().data();
  double* carry = carry_.data() + branch.carry_offset;
  std::fill_n(carry, 6 * supernodes[branch.last].rows_below(), 0.0);
  const auto add = [&](long entry, const double* values) {
    add_block(values,
              rows[entry] < branch.end_position ? x + 6L * rows[entry] : carry + 6L * carry_index[entry]);
  };
  for (const int child : symbolic_.child_branches(branch_index)) {
    const Branch& from = symbolic_.branches()[child];
    const Supernode& root = supernodes[from.last];
    const int* in_parent = symbolic_.row_in_parent().data() + root.first_row + root.width;
    for (int k = 0; k < root.rows_below(); ++k) {
      add(supernodes[root.parent].first_row + in_parent[k], carry_.data() + from.carry_offset + 6L * k);
    }
  }
  double* scratch = scratch_.data() + scratch_offset_[branch_index];
  for (int i = branch.first; i <= branch.last; ++i) {
    const Supernode& s = supernodes[i];
    const int ld = 6 * s.row_count, below = 6 * s.rows_below();
    const double* block = panel(s);
    double* own = x + 6L * s.first_position;
    for (int k = 0; k < s.width; ++k) {
      multiply_lower(block + 6 * k + 6L * k * ld, ld, own + 6 * k);
      subtract_matrix_vector(6 * (s.width - k - 1), 6, block + 6 * (k + 1) + 6L * k * ld, ld, own + 6 * k,
                             own + 6 * (k + 1));
    }
    std::fill_n(scratch, below, 0.0);
    subtract_matrix_vector(below, 6 * s.width, block + 6 * s.width, ld, own, scratch);
    for (int k = 0; k < s.rows_below(); ++k) add(s.first_row + s.width + k, scratch + 6 * k);
  }
}

void BlockCholesky::backward(int branch_index, double* x) {
  const Branch& branch = symbolic_.branches()[branch_index];
  double* scratch = scratch_.data() + scratch_offset_[branch_index];
  for (int i = branch.last; i >= branch.first; --i) {
    const Supernode& s = symbolic_.supernodes()[i];
    const int ld = 6 * s.row_count, below = 6 * s.rows_below();
    const double* block = panel(s);
    double* own = x + 6L * s.first_position;
    for (int k = 0; k < s.rows_below(); ++k) {
      copy_block(x + 6L * symbolic_.rows()[s.first_row + s.width + k], scratch + 6 * k);
    }
    subtract_transpose_vector(below, 6 * s.width, block + 6 * s.width, ld, scratch, own);
    for (int k = s.width - 1; k >= 0; --k) {
      subtract_transpose_vector(6 * (s.width - k - 1), 6, block + 6 * (k + 1) + 6L * k * ld, ld,
                                own + 6 * (k + 1), own + 6 * k);
      multiply_upper(block + 6 * k + 6L * k * ld, ld, own + 6 * k);
    }
  }
}

void BlockCholesky::forward(double* x) {
  for (int b = 0; b < static_cast<int>(symbolic_.branches().size()); ++b) forward(b, x);
}

void BlockCholesky::backward(double* x) {
  for (int b = static_cast<int>(symbolic_.branches().size()) - 1; b >= 0; --b) backward(b, x);
}

void BlockCholesky::to_positions(std::span<const double> by_node, std::vector<double>& by_position) const {
  by_position.resize(by_node.size());
  for (int p = 0; p < symbolic_.node_count(); ++p) {
    std::copy_n(by_node.data() + 6 * symbolic_.node_at_position()[p], 6, by_position.data() + 6 * p);
  }
}

void BlockCholesky::to_nodes(std::span<const double> by_position, std::span<double> by_node) const {
  for (int p = 0; p < symbolic_.node_count(); ++p) {
    std::copy_n(by_position.data() + 6 * p, 6, by_node.data() + 6 * symbolic_.node_at_position()[p]);
  }
}

void BlockCholesky::forward_many(double* y, int ld, std::span<const int> first,
                                 std::span<const int> last) const {
  const auto supernodes = symbolic_.supernodes();
  for (std::size_t i = 0; i < supernodes.size(); ++i) {
    const Supernode& s = supernodes[i];
    const int rows = last[i] - first[i];
    if (rows <= 0) continue;
    const int panel_ld = 6 * s.row_count;
    const double* block = panel(s);
    double* own = y + first[i] + 6L * s.first_position * ld;
    for (int k = 0; k < s.width; ++k) {
      double* column = own + 6L * k * ld;
      subtract_product(rows, 6 * k, own, ld, block + 6 * k, panel_ld, column, ld);
      multiply_by_transpose(rows, block + 6 * k + 6L * k * panel_ld, panel_ld, column, ld);
    }
    for (int k = s.width; k < s.row_count; ++k) {
      const int position = symbolic_.rows()[s.first_row + k];
      subtract_product(rows, 6 * s.width, own, ld, block + 6 * k, panel_ld, y + first[i] + 6L * position * ld,
                       ld);
    }
  }
}

}  // namespace cleave
