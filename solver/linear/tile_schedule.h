// The order in which the tiles of a symmetric matrix are factored, and which operation waits for which.
//
// The lower triangle is cut into square blocks. Step k of a right-looking Cholesky factorisation
//
//     factors the diagonal block            A_kk = L_kk L_kk^T
//     solves the blocks below it            L_ik = A_ik L_kk^-T
//     updates what is right of it           A_ij -= L_ik L_jk^T,    k < j <= i
//
// (Golub and Van Loan, Matrix Computations, section 4.2). Only the first columns of blocks may be listed: a
// panel. The diagonal block that the next step begins with comes first in every step, and its factorisation
// next, so that it is long done when the solves below it, last in the step, are reached (look-ahead;
// Strazdins 1998). On any number of threads every block sees the same operations in the same order.
//
// Where blocks are many they do not stay in a cache from one step to the next, and to read and write a block
// for a single product takes what memory gives: blocks whose turn is far off then wait for several steps, and
// are updated by all of these in one operation.
#pragma once

#include <utility>
#include <vector>

namespace cleave {

// What a step does to one block: a diagonal block (row = column = step) is factored, those below it are
// solved for, all others are updated, by steps step .. step + steps - 1.
struct TileOperation {
  int step, row, column;
  int steps = 1;
};

class TileSchedule {
 public:
  // columns: those that are listed, of as many steps. joined_steps: that update a block in one operation; the
  // last steps before its turn, fewer than twice as many, do so one by one, as the next block waits for them.
  TileSchedule(int blocks, int columns, int joined_steps = 1);

  // Each comes after all that it needs.
  const std::vector<TileOperation>& operations() const { return operations_; }
  // Pairs (earlier operation, later operation): the last one on its own block, and those that finished the
  // blocks it reads.
  const std::vector<std::pair<int, int>>& waits() const { return waits_; }
  // Of each operation a place in [0, 1): rows of blocks go round the threads, whatever their number.
  double place(int operation) const;
  // The last operation on a block of the lower triangle; -1 where there is none.
  int last_on(int row, int column) const { return last_on_block_[row * (row + 1) / 2 + column]; }

 private:
  void list(const TileOperation& operation);
  void list_updates(int step, int column, int first_row, int blocks, int joined_steps);

  std::vector<TileOperation> operations_;
  std::vector<std::pair<int, int>> waits_;
  std::vector<int> last_on_block_;
};

}  // namespace cleave
