// The inner loops of all products with J and its like: (m, 12) rows in groups between two bodies.
#pragma once

#include <algorithm>
#include <span>

#include "solver/prepared_step.h"

namespace cleave {

// sum (12) = sum over the rows r of the group of row_r^T value_of(r)
template <class Value>
void sum_rows(const RowGroup& group, const double* rows, const Value& value_of, double* sum) {
  std::fill_n(sum, 12, 0.0);
  for (int r = group.first_row; r < group.first_row + group.row_count; ++r) {
    const double value = value_of(r);
    for (int c = 0; c < 12; ++c) sum[c] += rows[12L * r + c] * value;
  }
}

// total (6) = base + the sums of the groups that a body is in; sides: PreparedStep::sides_of_body.
inline void add_sides(std::span<const int> sides, const double* group_sums, const double* base,
                      double* total) {
  double sum[6];
  std::copy_n(base, 6, sum);
  for (const int side : sides) {
    for (int c = 0; c < 6; ++c) sum[c] += group_sums[6L * side + c];
  }
  std::copy_n(sum, 6, total);
}

// both (12): velocities of the two bodies of a group; b is nullptr for static.
inline void load_pair(const double* a, const double* b, double* both) {
  std::copy_n(a, 6, both);
  if (b != nullptr) {
    std::copy_n(b, 6, both + 6);
  } else {
    std::fill_n(both + 6, 6, 0.0);
  }
}

// Summed in four lanes, as a vector: the compiler makes scalar instructions of the same loops.
inline double row_times(const double* row, const double* both) {
  using FourLanes [[gnu::vector_size(4 * sizeof(double))]] = double;
  FourLanes sum = {};
  for (int c = 0; c < 12; c += 4) {
    const FourLanes a = {row[c], row[c + 1], row[c + 2], row[c + 3]};
    const FourLanes b = {both[c], both[c + 1], both[c + 2], both[c + 3]};
    sum += a * b;
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace cleave
