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

using FourLanes [[gnu::vector_size(4 * sizeof(double))]] = double;

// Velocities of the two bodies of a group (12), put together in registers: read as vectors right after they were copied
// number by number, they would wait for memory. b is nullptr for static.
struct BodyPair {
  FourLanes part[3];
};

inline BodyPair load_pair(const double* a, const double* b) {
  static constexpr double kStatic[6] = {};
  if (b == nullptr) b = kStatic;
  return {{FourLanes{a[0], a[1], a[2], a[3]}, FourLanes{a[4], a[5], b[0], b[1]},
           FourLanes{b[2], b[3], b[4], b[5]}}};
}

// Of velocities that stand one after the other.
inline BodyPair load_pair(const double* both) {
  const auto four = [&](int c) { return FourLanes{both[c], both[c + 1], both[c + 2], both[c + 3]}; };
  return {{four(0), four(4), four(8)}};
}

// Summed in four lanes, as a vector: the compiler makes scalar instructions of the same loops.
inline double row_times(const double* row, const BodyPair& both) {
  FourLanes sum = {};
  for (int k = 0; k < 3; ++k) {
    const FourLanes a = {row[4 * k], row[4 * k + 1], row[4 * k + 2], row[4 * k + 3]};
    sum += a * both.part[k];
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace cleave
