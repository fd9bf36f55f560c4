#include "harness/files/matrix_entries.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace cleave {

void sum_entries(std::vector<MatrixEntry>& entries) {
  const auto place = [](const MatrixEntry& entry) { return std::tuple(entry.column, entry.row); };
  std::ranges::stable_sort(entries, {}, place);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < entries.size();) {
    MatrixEntry sum = entries[k++];
    for (; k < entries.size() && place(entries[k]) == place(sum); ++k) sum.value += entries[k].value;
    if (sum.value != 0) entries[kept++] = sum;
  }
  entries.resize(kept);
}

std::vector<MatrixEntry> jacobian_entries(const StepProblem& problem, int row) {
  std::vector<MatrixEntry> entries;
  for (int side = 0; side < 2; ++side) {
    const int body = problem.row_body[2 * std::size_t(row) + side];
    for (int k = 0; body >= 0 && k < 6; ++k)
      entries.push_back({row, 6 * body + k, problem.jacobian[12 * std::size_t(row) + 6 * side + k]});
  }
  return entries;
}

}  // namespace cleave
