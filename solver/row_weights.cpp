#include "solver/row_weights.h"

#include <algorithm>
#include <cassert>
#include <type_traits>

#include "solver/linear/four_lanes.h"

namespace cleave {
namespace {

// Sizes are known to the compiler: a solve comes here several times an iteration. call(std::integral_constant
// of the block's rows).
template <class Call>
void with_row_count(const WeightBlock& block, const Call& call) {
  switch (block.row_count) {
    case 1:
      return call(std::integral_constant<int, 1>());
    case 2:
      return call(std::integral_constant<int, 2>());
    default:
      return call(std::integral_constant<int, 3>());
  }
}

// The entries of a block in x (m), multiplied by B^T or B.
template <bool kTransposed>
void multiply_entries(const WeightBlock& block, double* x) {
  with_row_count(block, [&](auto count) {
    constexpr int kCount = count;
    double result[kCount] = {};
    for (int i = 0; i < kCount; ++i) {
      for (int k = 0; k < kCount; ++k)
        result[i] += block.basis[kTransposed ? kCount * i + k : kCount * k + i] * x[block.first_row + k];
    }
    std::copy_n(result, kCount, x + block.first_row);
  });
}

// The rows of a block in x (m, 12), multiplied by B^T from the left, into those of y, which is not x.
void multiply_rows(const WeightBlock& block, const double* x, double* y) {
  const std::ptrdiff_t first = 12L * block.first_row;
  with_row_count(block, [&](auto count) {
    constexpr int kCount = count;
    for (std::ptrdiff_t c = first; c < first + 12; c += 4) {
      FourLanes row[kCount];
      for (int k = 0; k < kCount; ++k) row[k] = read<FourLanes>(x + c + 12 * k);
      for (int i = 0; i < kCount; ++i) {
        FourLanes sum = {};
        for (int k = 0; k < kCount; ++k) sum += block.basis[kCount * i + k] * row[k];
        write(sum, y + c + 12 * i);
      }
    }
  });
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
  for (const WeightBlock& block : blocks) multiply_entries<true>(block, x.data());
}

void from_basis(std::span<const WeightBlock> blocks, std::span<double> x) {
  for (const WeightBlock& block : blocks) multiply_entries<false>(block, x.data());
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
    multiply_rows(*next[k], rows, turned);
    row += next[k]++->row_count;
  }
}

}  // namespace cleave
