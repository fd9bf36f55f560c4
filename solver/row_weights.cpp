#include "solver/row_weights.h"

#include <algorithm>
#include <cassert>

namespace cleave {
namespace {

// The rows of a block of x (m, kWidth), multiplied by B^T or B from the left. All sizes are known to the compiler: a solve
// comes here three times an iteration.
template <int kCount, int kWidth, bool kTransposed>
void multiply_rows(const WeightBlock& block, double* x) {
  x += static_cast<std::ptrdiff_t>(kWidth) * block.first_row;
  double result[kCount][kWidth] = {};
  for (int i = 0; i < kCount; ++i) {
    for (int k = 0; k < kCount; ++k) {
      const double share = block.basis[kTransposed ? kCount * i + k : kCount * k + i];
      for (int c = 0; c < kWidth; ++c) result[i][c] += share * x[kWidth * k + c];
    }
  }
  std::copy_n(&result[0][0], kCount * kWidth, x);
}

template <int kWidth, bool kTransposed>
void multiply_blocks(std::span<const WeightBlock> blocks, double* x) {
  for (const WeightBlock& block : blocks) {
    switch (block.row_count) {
      case 1:
        multiply_rows<1, kWidth, kTransposed>(block, x);
        break;
      case 2:
        multiply_rows<2, kWidth, kTransposed>(block, x);
        break;
      default:
        multiply_rows<3, kWidth, kTransposed>(block, x);
    }
  }
}

bool fits(const StepProblem& problem, const WeightBlock& block) {
  if (block.row_count < 1 || block.row_count > 3 || block.first_row < 0) return false;
  if (block.first_row + block.row_count > problem.row_count()) return false;
  const int* body = problem.row_body.data() + 2 * block.first_row;
  for (int k = 1; k < block.row_count; ++k) {
    if (body[2 * k] != body[0] || body[2 * k + 1] != body[1]) return false;
  }
  return true;
}

}  // namespace

void to_basis(std::span<const WeightBlock> blocks, std::span<double> x) {
  multiply_blocks<1, true>(blocks, x.data());
}

void from_basis(std::span<const WeightBlock> blocks, std::span<double> x) {
  multiply_blocks<1, false>(blocks, x.data());
}

void WeightedRows::set(const StepProblem& problem, const RowWeights& weights) {
  d_ = weights.d;
  blocks_ = weights.blocks;
  jacobian_ = problem.jacobian.data();
  if (blocks_.empty()) return;
  turned_jacobian_ = problem.jacobian;
  jacobian_ = turned_jacobian_.data();
  assert(std::ranges::all_of(blocks_, [&](const WeightBlock& block) { return fits(problem, block); }));
  multiply_blocks<12, true>(blocks_, turned_jacobian_.data());
}

}  // namespace cleave
