// The inner loops of all products with J and its like: (m, 12) rows in groups between two bodies.
#pragma once

#include <algorithm>
#include <span>

#include "solver/linear/four_lanes.h"
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

// Velocities of the two bodies of a group (12), put together in registers: read as vectors right after they
// were copied number by number, they would wait for memory. b is nullptr for static.
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
  return {{read<FourLanes>(both), read<FourLanes>(both + 4), read<FourLanes>(both + 8)}};
}

// The products of a row in four lanes, as a vector: the compiler makes scalar instructions of the same loops.
inline FourLanes lane_products(const double* row, const BodyPair& both) {
  FourLanes sum = {};
  for (int k = 0; k < 3; ++k) sum += read<FourLanes>(row + 4 * k) * both.part[k];
  return sum;
}

inline double row_times(const double* row, const BodyPair& both) {
  const FourLanes sum = lane_products(row, both);
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

// row_times of four rows that follow each other, by the same additions.
inline FourLanes four_rows_times(const double* row, const BodyPair& both) {
  const auto in_pairs = [&](int r) {
    const FourLanes a = lane_products(row + 12L * r, both), b = lane_products(row + 12L * (r + 1), both);
    return __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  };
  const FourLanes first = in_pairs(0), second = in_pairs(2);
  return __builtin_shufflevector(first, second, 0, 1, 4, 5) +
         __builtin_shufflevector(first, second, 2, 3, 6, 7);
}

// visit(r, row_r . both) for the rows of a group: for four of them at a time as FourLanes, for what is left
// as doubles.
template <class Visit>
void visit_products(const RowGroup& group, const double* rows, const BodyPair& both, const Visit& visit) {
  int r = group.first_row;
  const int end = r + group.row_count;
  for (; r + 4 <= end; r += 4) visit(r, four_rows_times(rows + 12L * r, both));
  for (; r < end; ++r) visit(r, row_times(rows + 12L * r, both));
}

}  // namespace cleave
