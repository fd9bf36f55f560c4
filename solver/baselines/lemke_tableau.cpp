#include "solver/baselines/lemke_tableau.h"

#include <algorithm>
#include <cmath>

#include "harness/base/stop.h"

namespace cleave {
namespace {

constexpr double kLeastPivot =
    1e-12;  // of the largest entry of the entering column, or of 1; 1e-10 leaves stiff rows out
constexpr double kTie = 1e-12;  // ratios that differ by less are rounding of equal ones

}  // namespace

void LemkeTableau::resize(int n) {
  n_ = n;
  width_ = 2 * static_cast<std::size_t>(n) + 2;
  tableau_.assign(n * width_, 0.0);
  basis_.resize(n);
  row_of_z_.assign(n, -1);
  for (int i = 0; i < n; ++i) {
    basis_[i] = w_column(i);
    at(i, w_column(i)) = 1;
    at(i, z0_column()) = -1;
  }
}

LemkeTableau::End LemkeTableau::solve(int most_pivots, const std::atomic<bool>* stop) {
  pivots_ = 0;
  scale_ = 0;
  for (int i = 0; i < n_; ++i) scale_ = std::max(scale_, std::abs(at(i, 0)));
  int row = first_leaving(), entering = z0_column();
  while (row >= 0) {
    check_stop(stop);
    if (pivots_ == most_pivots) {
      read_basis();
      return End::pivot_limit;
    }
    const int left = basis_[row];
    pivot(row, entering);
    if (left == z0_column()) break;
    entering = complement(left);
    row = leaving(entering);
    if (row < 0) {
      read_basis();
      return End::ray;
    }
  }
  read_basis();
  return End::solved;
}

// The lexicographically least row of [q, I]: of equal q the last, as its unit comes latest. -1: q >= 0, and z
// = 0 it is.
int LemkeTableau::first_leaving() const {
  int least = -1;
  double q = 0;
  for (int i = 0; i < n_; ++i) {
    const double here = tableau_[i * width_];
    if (here < 0 && here <= q) least = i, q = here;
  }
  return least;
}

// The row whose basic variable the entering one drives to zero first; -1 where it meets none.
int LemkeTableau::leaving(int entering) {
  double largest = 1;
  for (int i = 0; i < n_; ++i) largest = std::max(largest, std::abs(at(i, entering)));
  candidates_.clear();
  for (int i = 0; i < n_; ++i)
    if (at(i, entering) > kLeastPivot * largest) candidates_.push_back(i);
  if (candidates_.empty()) return -1;
  keep_least(0, entering);
  for (const int row : candidates_)
    if (basis_[row] == z0_column()) return row;
  for (int i = 0; i < n_ && candidates_.size() > 1; ++i) keep_least(w_column(i), entering);
  return candidates_.front();
}

// Leaves those candidates whose ratio of this column to the entering one is the least.
void LemkeTableau::keep_least(int column, int entering) {
  const auto ratio = [&](int row) { return at(row, column) / at(row, entering); };
  const double unit = column == 0 ? scale_ : 1;
  double least = ratio(candidates_.front());
  for (const int row : candidates_) least = std::min(least, ratio(row));
  std::erase_if(candidates_, [&](int row) {
    const double above = at(row, column) - least * at(row, entering);
    return above > kTie * std::max(unit, std::abs(at(row, column)));
  });
}

void LemkeTableau::pivot(int row, int column) {
  ++pivots_;
  double* of_row = tableau_.data() + row * width_;
  const double inverse = 1 / of_row[column];
  for (std::size_t c = 0; c < width_; ++c) of_row[c] *= inverse;
  of_row[column] = 1;
  for (int i = 0; i < n_; ++i) {
    double* other = tableau_.data() + i * width_;
    const double factor = other[column];
    if (i == row || factor == 0) continue;
    for (std::size_t c = 0; c < width_; ++c) other[c] -= factor * of_row[c];
    other[column] = 0;
    other[0] = std::max(other[0], 0.0);  // never negative but for rounding
  }
  basis_[row] = column;
}

void LemkeTableau::read_basis() {
  for (int i = 0; i < n_; ++i)
    if (basis_[i] >= z_column(0) && basis_[i] < z0_column()) row_of_z_[basis_[i] - z_column(0)] = i;
}

}  // namespace cleave
