// Triangular solves with the factor of block_cholesky.h.
#include <algorithm>

#include "solver/block_cholesky.h"
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
