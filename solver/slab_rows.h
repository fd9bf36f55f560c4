// Rows of Gauss-Seidel sweeps as slab_sweeps.h goes through them: in single precision, two cache lines a row.
#pragma once

#include <span>

#include "solver/prepared_step.h"

namespace cleave {

// All that a sweep needs of a row, in two cache lines; lambda_r - w_r / d = kept lambda_r + push - (J_r / d) v
// with d = d_r / omega. The numbers of a body are followed by two more: zeros, but in J / d, where a velocity's are zero too.
struct alignas(64) SlabRow {
  float jacobian_a[8], jacobian_b[8];  // J_r / d
  float mass_jacobian_a[8], mass_jacobian_b[8];

  float& kept() { return jacobian_a[6]; }
  float& push() { return jacobian_a[7]; }
  float& lower() { return jacobian_b[6]; }  // finite, so that its product with zero is zero
  float& upper() { return jacobian_b[7]; }
  float kept() const { return jacobian_a[6]; }
  float push() const { return jacobian_a[7]; }
  float lower() const { return jacobian_b[6]; }
  float upper() const { return jacobian_b[7]; }
};

struct alignas(64) SlabBody {
  float velocity[8];  // and two zeros
};

// Where a sweep finds what it needs; places are those of slab_sweeps.h.
struct SlabArrays {
  std::span<const RowGroup> groups;
  const int *place_of_body, *place_of_group;
  const SlabRow* rows;  // by place
  float* impulse;       // by place
  SlabBody* bodies;     // by place, and one that stands still
  int still;
};

// Visits every row of these groups once, in their order. Groups of many rows first, and no two of them on one body:
// six go side by side.
void visit_groups(const SlabArrays& arrays, std::span<const int> groups);

}  // namespace cleave
