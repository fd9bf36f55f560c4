// A large front of the multifrontal factorisation in tiles, so that several threads can work on it.
//
// A front is the supernode's panel (its own columns, all its rows) and the update matrix that it leaves to
// its parent, together the lower triangle of a square matrix of 6x6 blocks. Its rows are cut into strips of
// nearly equal size, no strip partly among the own columns; tile (i, j) is where strip i of rows meets strip
// j of columns. The tiles of the panel are factored as linear/tile_schedule.h says; those of the update
// matrix are then each made in one go.
#pragma once

#include "solver/block_symbolic.h"
#include "solver/linear/tile_schedule.h"

namespace cleave {

// Where the strips of a supernode begin, in blocks; of its pattern alone.
class FrontStrips {
 public:
  explicit FrontStrips(const Supernode& s);
  int own() const { return own_; }
  int count() const { return own_ + below_; }
  int joined_steps() const;  // of its TileSchedule
  int begin(int strip) const;
  int end(int strip) const { return begin(strip + 1); }

 private:
  int width_, rows_below_, own_, below_;
};

class FrontTiles {
 public:
  // panel, update: of this supernode, the panel assembled.
  FrontTiles(const Supernode& s, double* panel, double* update);

  // Of the panel. False when a pivot is not positive.
  bool run(const TileOperation& operation);
  // Of the update matrix, once the panel is factored: A_ij -= L_i L_j^T.
  void subtract_panel_product(int row, int column);

 private:
  bool factor_diagonal(int step);
  void solve_below(int step, int row);
  // A_ij -= L_ik L_jk^T, k = step
  void update(int step, int row, int column);
  double* at(int row, int column) const;
  int leading_dimension(int column) const { return 6 * (column < width_ ? row_count_ : row_count_ - width_); }

  FrontStrips strips_;
  int width_, row_count_;
  double *panel_, *update_;
};

}  // namespace cleave
