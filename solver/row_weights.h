// The weights D of a kernel's system: a number per row or, per contact, a symmetric block.
//
// A block spans up to three adjacent rows between the same two bodies. It is given by a basis B (any matrix)
// and the numbers d >= 0 of its rows,
//
//     D_block = B diag(d) B^T,
//
// so that it is positive semidefinite whatever rounding does, and a stiff direction of a contact does not
// drown a soft one: written out in nine numbers, a weight of 1e-9 beside one of 1e9 would be lost. For the
// same reason right-hand sides and impulses of a block are numbers along its basis, f_r' = B^T f_r and
// dlambda = B dlambda'. With J' = B^T J on its rows, and J' = J on others, the system is
//
//     M dv - J'^T dlambda' = f_v,     J' dv + diag(d)^-1 dlambda' = f_r',
//
// where a block that is singular needs no inverse.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "solver/step_problem.h"

namespace cleave {

struct WeightBlock {
  int first_row = 0;
  int row_count = 3;              // 1 to 3
  std::array<double, 9> basis{};  // B: column k at basis[row_count * k]
};

// Both arrays must stay where they are until the kernel factors again.
struct RowWeights {
  RowWeights(std::span<const double> row_weights, std::span<const WeightBlock> weight_blocks = {})
      : d(row_weights), blocks(weight_blocks) {}
  RowWeights(const std::vector<double>& row_weights) : d(row_weights) {}

  std::span<const double> d;  // (m) >= 0; on the rows of a block, of the columns of its basis
  // Disjoint; ascending, or two such runs, as turned boxes and then cones. Rows outside of them are scalar.
  std::span<const WeightBlock> blocks;
};

// x (m) <- B^T x and x <- B x on the rows of the blocks.
void to_basis(std::span<const WeightBlock> blocks, std::span<double> x);
void from_basis(std::span<const WeightBlock> blocks, std::span<double> x);

// The rows of a problem as a kernel sees them under given weights. Without blocks nothing is copied.
class WeightedRows {
 public:
  // All of J' is then to be made by turn().
  void set(const StepProblem& problem, const RowWeights& weights);
  // Makes J' of rows first .. last - 1 that cut no block in two; calls for other rows may run beside it.
  void turn(std::pair<int, int> range);

  std::span<const double> d() const { return d_; }
  const double* jacobian() const { return jacobian_; }  // (m, 12) J'

 private:
  std::span<const double> d_;
  std::span<const WeightBlock> blocks_;
  std::span<const WeightBlock> runs_[2];  // of blocks_
  const StepProblem* problem_ = nullptr;
  const double* jacobian_ = nullptr;
  std::vector<double> turned_jacobian_;
};

}  // namespace cleave
