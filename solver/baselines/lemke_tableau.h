// Lemke's complementary pivots on the linear complementarity problem (LCP): find
//
//     w = M z + q,   w >= 0,  z >= 0,  w^T z = 0.
//
// An artificial variable z0 makes the start feasible, w = M z + q + e z0 with e all ones. z0 enters where q
// is most negative; after that the complement of the variable that has left enters, until z0 leaves (solved)
// or nothing can (a ray). The variable that leaves is that of the lexicographically least row of [q, B^-1]
// over the entering column, B the basis matrix: no basis comes twice, however degenerate the problem is.
// Where z0 may leave, it does.
//
// For M positive semidefinite, and a bit beyond, a ray means that no z >= 0 has M z + q >= 0 (Cottle, Pang
// and Stone, theorem 4.4.13) -- in exact arithmetic. The number of pivots can grow like 2^n (Murty 1978), and
// is about n mostly.
//
// Source: Lemke, Management Science 11, 1965; Cottle, Pang and Stone, The Linear Complementarity Problem,
// 1992, section 4.4 (algorithm) and 4.9 (lexicographic degeneracy resolution); Murty, Linear Complementarity,
// Linear and Nonlinear Programming, 1988, chapter 2. The tableau is kept whole, n x (2 n + 2) numbers:
// columns q, w, z, z0.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

namespace cleave {

class LemkeTableau {
 public:
  enum class End { solved, ray, pivot_limit };

  // How many numbers resize(n) allocates.
  static std::uint64_t size_of(std::uint64_t n) { return n * (2 * n + 2); }

  // M and q all zero, z not known. Entries of M should be about 1 or less: tolerances are meant for that.
  void resize(int n);
  void set_matrix(int row, int column, double value) { at(row, z_column(column)) = -value; }
  void set_constant(int row, double value) { at(row, 0) = value; }

  // Once after every resize(), when M and q are set. Looks at stop before every pivot (stop.h).
  End solve(int most_pivots, const std::atomic<bool>* stop = nullptr);

  // Of the end: whether z_i is basic, which means w_i = 0, and its value.
  bool is_basic(int i) const { return row_of_z_[i] >= 0; }
  double value(int i) const { return is_basic(i) ? tableau_[row_of_z_[i] * width_] : 0; }
  int pivots() const { return pivots_; }

 private:
  int w_column(int i) const { return 1 + i; }
  int z_column(int i) const { return 1 + n_ + i; }
  int z0_column() const { return 1 + 2 * n_; }
  double& at(int row, int column) { return tableau_[row * width_ + column]; }
  int complement(int column) const { return column <= n_ ? column + n_ : column - n_; }
  int first_leaving() const;
  int leaving(int entering);
  void keep_least(int column, int entering);
  void pivot(int row, int column);
  void read_basis();

  int n_ = 0, pivots_ = 0;
  std::size_t width_ = 0;
  double scale_ = 1;             // of q
  std::vector<double> tableau_;  // (n, 2 n + 2) of w - M z - e z0 = q, times B^-1
  std::vector<int> basis_;       // (n) column of the basic variable of every row
  std::vector<int> row_of_z_;    // (n) at the end
  std::vector<int> candidates_;  // rows that may leave
};

}  // namespace cleave
