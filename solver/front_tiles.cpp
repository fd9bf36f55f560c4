#include "solver/front_tiles.h"

#include <algorithm>

#include "harness/base/ceil_div.h"
#include "solver/linear/dense_block.h"

namespace cleave {
namespace {

// Blocks of a strip: so many strips that many workers share a front, but none so thin that its tasks are lost
// in what it costs to hand them out, nor so thick that its tiles do not fit in a core's cache.
constexpr int kStrips = 12, kLeastStrip = 8, kMostStrip = 16;

// A front of more strips does not stay in the caches from step to step. Eight and sixteen steps at once are
// no faster than four, in a silo of 27 000 on two threads.
constexpr int kStripsThatStay = 24, kJoinedSteps = 4;

int strips_of(int blocks, int strip) { return ceil_div(blocks, strip); }

}  // namespace

FrontStrips::FrontStrips(const Supernode& s) : width_(s.width), rows_below_(s.rows_below()) {
  const int strip = std::clamp(s.row_count / kStrips, kLeastStrip, kMostStrip);
  own_ = strips_of(width_, strip);
  below_ = strips_of(rows_below_, strip);
}

int FrontStrips::joined_steps() const { return count() > kStripsThatStay ? kJoinedSteps : 1; }

int FrontStrips::begin(int strip) const {
  if (strip <= own_) return strip * width_ / own_;
  return width_ + (strip - own_) * rows_below_ / below_;
}

FrontTiles::FrontTiles(const Supernode& s, double* panel, double* update)
    : strips_(s), width_(s.width), row_count_(s.row_count), panel_(panel), update_(update) {}

// Of a block.
double* FrontTiles::at(int row, int column) const {
  const long ld = leading_dimension(column);
  if (column < width_) return panel_ + 6 * row + 6 * column * ld;
  return update_ + 6 * (row - width_) + 6 * (column - width_) * ld;
}

bool FrontTiles::run(const TileOperation& operation) {
  const auto [step, row, column, steps] = operation;
  if (column > step) {
    for (int k = step; k < step + steps; ++k) update(k, row, column);
  } else if (row > step) {
    solve_below(step, row);
  } else {
    return factor_diagonal(step);
  }
  return true;
}

bool FrontTiles::factor_diagonal(int step) {
  const int begin = strips_.begin(step), columns = strips_.end(step) - begin;
  return eliminate_columns(columns, columns, at(begin, begin), 6 * row_count_);
}

void FrontTiles::solve_below(int step, int row) {
  const int begin = strips_.begin(step), first = strips_.begin(row), ld = 6 * row_count_;
  const int rows = 6 * (strips_.end(row) - first);
  for (int k = begin; k < strips_.end(step); ++k) {
    subtract_product(rows, 6 * (k - begin), at(first, begin), ld, at(k, begin), ld, at(first, k), ld);
    multiply_by_transpose(rows, at(k, k), ld, at(first, k), ld);
  }
}

void FrontTiles::update(int step, int row, int column) {
  const int begin = strips_.begin(step), depth = 6 * (strips_.end(step) - begin), ld = 6 * row_count_;
  const int last = strips_.end(row);
  for (int c = strips_.begin(column); c < strips_.end(column); ++c) {
    const int first = std::max(strips_.begin(row), c);
    subtract_product(6 * (last - first), depth, at(first, begin), ld, at(c, begin), ld, at(first, c),
                     leading_dimension(c));
  }
}

void FrontTiles::subtract_panel_product(int row, int column) {
  for (int step = 0; step < strips_.own(); ++step) update(step, row, column);
}

}  // namespace cleave
