#include "solver/row_weights.h"

#include <algorithm>
#include <cassert>

namespace cleave {
namespace {

// The rows of a block of x (m, kWidth), multiplied by B^T or B from the left, into those of y; y may be x. All sizes are known
// to the compiler: a solve comes here three times an iteration.
template <int kCount, int kWidth, bool kTransposed>
void multiply_rows(const WeightBlock& block, const double* x, double* y) {
  const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(kWidth) * block.first_row;
  double result[kCount][kWidth] = {};
  for (int i = 0; i < kCount; ++i) {
    for (int k = 0; k < kCount; ++k) {
      const double share = block.basis[kTransposed ? kCount * i + k : kCount * k + i];
      for (int c = 0; c < kWidth; ++c) result[i][c] += share * x[first + kWidth * k + c];
    }
  }
  std::copy_n(&result[0][0], kCount * kWidth, y + first);
}

template <int kWidth, bool kTransposed>
void multiply_block(const WeightBlock& block, const double* x, double* y) {
  switch (block.row_count) {
    case 1:
      return multiply_rows<1, kWidth, kTransposed>(block, x, y);
    case 2:
      return multiply_rows<2, kWidth, kTransposed>(block, x, y);
    default:
      return multiply_rows<3, kWidth, kTransposed>(block, x, y);
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
  for (const WeightBlock& block : blocks) multiply_block<1, true>(block, x.data(), x.data());
}

void from_basis(std::span<const WeightBlock> blocks, std::span<double> x) {
  for (const WeightBlock& block : blocks) multiply_block<1, false>(block, x.data(), x.data());
}

void WeightedRows::set(const StepProblem& problem, const RowWeights& weights) {
  d_ = weights.d;
  blocks_ = weights.blocks;
  problem_ = &problem;
  jacobian_ = problem.jacobian.data();
  if (blocks_.empty()) return;
  assert(std::ranges::all_of(blocks_, [&](const WeightBlock& block) { return fits(problem, block); }));
  const auto second = std::ranges::is_sorted_until(blocks_, {}, &WeightBlock::first_row);
  runs_[0] = {blocks_.begin(), second};
  runs_[1] = {second, blocks_.end()};
  assert(std::ranges::is_sorted(runs_[1], {}, &WeightBlock::first_row));
  turned_jacobian_.resize(problem.jacobian.size());
  jacobian_ = turned_jacobian_.data();
}

// The rows between blocks are copied.
void WeightedRows::turn(std::pair<int, int> range) {
  if (blocks_.empty()) return;
  const int first = range.first, last = range.second;
  const double* rows = problem_->jacobian.data();
  double* turned = turned_jacobian_.data();
  std::span<const WeightBlock>::iterator next[2];
  for (int k = 0; k < 2; ++k)
    next[k] = std::ranges::lower_bound(runs_[k], first, {}, &WeightBlock::first_row);
  const auto next_row = [&](int k) { return next[k] == runs_[k].end() ? last : next[k]->first_row; };
  for (int row = first; row < last;) {
    const int k = next_row(0) <= next_row(1) ? 0 : 1, until = std::min(next_row(k), last);
    std::copy(rows + 12L * row, rows + 12L * until, turned + 12L * row);
    row = until;
    if (row == last) break;
    multiply_block<12, true>(*next[k], rows, turned);
    row += next[k]++->row_count;
  }
}

}  // namespace cleave
