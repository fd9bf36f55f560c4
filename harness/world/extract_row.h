// One constraint row on its way into a StepProblem.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "solver/row_arrays.h"

namespace cleave {

struct ExtractedRow {
  int body_a = -1;                    // never -1 in a problem
  int body_b = -1;                    // -1: static
  std::array<double, 12> jacobian{};  // linear and angular part of body_a, then of body_b
  double rhs_m_per_s = 0;
  double compliance = 0;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  RowKind kind = RowKind::bilateral;
  int normal_row = -1;  // of a friction row
  double mu = 0;        // of a friction row whose bound follows its normal impulse
  int constraint = -1;
  std::array<double, 3> point_m{};
  double warm_impulse = 0;
};

// Room for so many rows: a problem grows to hundreds of megabytes, which are not to be moved on the way.
inline void reserve_rows(std::size_t rows, StepProblem& problem) {
  visit_row_arrays([&](const char*, auto member, std::size_t width, RowArray kind) {
    if (kind == RowArray::always) (problem.*member).reserve(width * rows);
  });
}

// Appends the row to every row array of the problem and returns its index.
inline int append_row(const ExtractedRow& row, StepProblem& problem) {
  problem.row_body.insert(problem.row_body.end(), {row.body_a, row.body_b});
  problem.jacobian.insert(problem.jacobian.end(), row.jacobian.begin(), row.jacobian.end());
  problem.rhs.push_back(row.rhs_m_per_s);
  problem.compliance.push_back(row.compliance);
  problem.lower.push_back(row.lower);
  problem.upper.push_back(row.upper);
  problem.row_kind.push_back(row.kind);
  problem.friction_row.push_back(row.normal_row);
  problem.friction_coefficient.push_back(row.mu);
  problem.row_constraint.push_back(row.constraint);
  problem.contact_point.insert(problem.contact_point.end(), row.point_m.begin(), row.point_m.end());
  problem.warm_impulse.push_back(row.warm_impulse);
  return problem.row_count() - 1;
}

}  // namespace cleave
