// Numeric Cholesky factorisation H = L L^T of a sparse matrix of 6x6 blocks, multifrontal on supernodes.
//
// Each supernode owns a dense panel (its columns, all its rows). It adds what its children left to it,
// factors its columns and leaves its own update matrix to its parent, U = -L21 L21^T and what its children
// left to the rows below (Duff and Reid 1983). The inverse of every 6x6 diagonal block of L is stored in the
// place of the block. Right-hand sides are (n, 6) by node.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/block_symbolic.h"
#include "solver/front_tiles.h"

namespace cleave {

class BlockCholesky {
 public:
  // Where the block of a node pair is stored: offset into panels(), its leading dimension, and whether it is
  // stored as (row of second node, column of first) = false or the other way round = true.
  struct Place {
    long offset = 0;
    int leading_dimension = 0;
    bool transposed = false;
  };

  // The pattern alone. False where the factor has more than most_blocks (block_symbolic.h).
  bool analyze(int node_count, std::span<const std::pair<int, int>> edges,
               std::span<const int> stage_of_node = {}, int stage_count = 1,
               long most_blocks = BlockSymbolic::kAnyBlocks);
  // What pattern and factor take; then the factor's memory, without which only place() and holds() may be
  // used.
  void count(MemoryCount& memory) const;
  void allocate();
  const BlockSymbolic& symbolic() const { return symbolic_; }

  // Of a pair that holds() says is in the pattern of the factor, fill included.
  Place place(int first_node, int second_node) const;
  bool holds(int first_node, int second_node) const { return row_of_block(first_node, second_node) >= 0; }
  double* panels() { return panels_.data(); }
  void set_zero(int branch);

  // Factors the supernodes of one branch, after its child branches. False when a pivot is not positive.
  bool factor(int branch);
  // The same of a branch that is one supernode, in pieces (front_tiles.h): adds what its children left to
  // strips of columns of its panel; makes tiles of its update matrix once the panel is factored.
  void gather(int supernode, int column_strip);
  void make_update(int supernode, int row_strip, int column_strip);
  FrontTiles front(int supernode);

  // Substitution (block_substitution.cpp).
  // x <- L^-1 x and x <- L^-T x, x in position order, 6 doubles each. One branch after its child branches, or
  // after its parent; each writes to its own places of x alone, and forward leaves what it adds above to its
  // parent.
  void forward(int branch, double* x);
  void backward(int branch, double* x);
  // The same of all branches.
  void forward(double* x);
  void backward(double* x);
  void to_positions(std::span<const double> by_node, std::vector<double>& by_position) const;
  void to_nodes(std::span<const double> by_position, std::span<double> by_node) const;

  // Y <- L^-1 Y for many right-hand sides. Transposed storage: right-hand side k of
  // unknown c (position order) at y[k + c * ld]. In the columns of supernode s only right-hand sides first[s]
  // .. last[s] may be non-zero; both bounds are even.
  void forward_many(double* y, int ld, std::span<const int> first, std::span<const int> last) const;

  const double* panel(const Supernode& s) const { return panels_.data() + s.panel_offset; }

 private:
  int row_of_block(int first_node, int second_node) const;
  // Of a front, in blocks.
  struct Range {
    int first_row, last_row, first_column, last_column;
  };
  void add_update(const Supernode& child, const Supernode& parent, const Range& range);
  void add_updates(int supernode, const Range& range);
  void begin_update(const Supernode& s);

  BlockSymbolic symbolic_;
  std::vector<double> panels_, updates_;
  std::vector<double> carry_, scratch_;  // of all branches
  std::vector<long> scratch_offset_;     // by branch, then their end
};

}  // namespace cleave
