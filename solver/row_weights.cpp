#include "solver/row_weights.h"

#include <cassert>

namespace cleave {
namespace {

// The rows first .. first + count of x (m, width), multiplied by B^T or B from the left.
void multiply_rows(const WeightBlock& block, bool transposed, int width, double* x) {
  const int count = block.row_count;
  x += static_cast<std::ptrdiff_t>(width) * block.first_row;
  for (int c = 0; c < width; ++c) {
    double result[3] = {};
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < count; ++k) {
        result[i] += block.basis[transposed ? count * i + k : count * k + i] * x[width * k + c];
      }
    }
    for (int i = 0; i < count; ++i) x[width * i + c] = result[i];
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
  for (const WeightBlock& block : blocks) multiply_rows(block, true, 1, x.data());
}

void from_basis(std::span<const WeightBlock> blocks, std::span<double> x) {
  for (const WeightBlock& block : blocks) multiply_rows(block, false, 1, x.data());
}

void WeightedRows::set(const StepProblem& problem, const RowWeights& weights) {
  d_ = weights.d;
  blocks_ = weights.blocks;
  jacobian_ = problem.jacobian.data();
  if (blocks_.empty()) return;
  turned_jacobian_ = problem.jacobian;
  jacobian_ = turned_jacobian_.data();
  for (const WeightBlock& block : blocks_) {
    assert(fits(problem, block));
    multiply_rows(block, true, 12, turned_jacobian_.data());
  }
}

}  // namespace cleave
