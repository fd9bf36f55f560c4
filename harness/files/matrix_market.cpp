#include "harness/files/matrix_market.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <vector>

#include "harness/base/numbers.h"
#include "harness/files/interface_matrix.h"
#include "harness/files/matrix_entries.h"

namespace cleave {
namespace {

std::string coordinate_text(const std::string& symmetry, const std::string& comment, int rows, int columns,
                            std::vector<MatrixEntry> entries) {
  sum_entries(entries);
  std::string lines;
  for (const MatrixEntry& entry : entries)
    lines += std::to_string(entry.row + 1) + " " + std::to_string(entry.column + 1) + " " +
             number_text(entry.value) + "\n";
  return "%%MatrixMarket matrix coordinate real " + symmetry + "\n% " + comment + "\n" +
         std::to_string(rows) + " " + std::to_string(columns) + " " + std::to_string(entries.size()) + "\n" +
         lines;
}

// The mass alone.
std::string mass_text(const StepProblem& problem, const StoredPartition*) {
  const int size = 6 * problem.body_count();
  return coordinate_text("symmetric", "M, mass", size, size, system_entries(problem, {}));
}

std::string jacobian_text(const StepProblem& problem, const StoredPartition*) {
  std::vector<MatrixEntry> entries;
  for (int row = 0; row < problem.row_count(); ++row)
    std::ranges::copy(jacobian_entries(problem, row), std::back_inserter(entries));
  return coordinate_text("general", "J, Jacobian", problem.row_count(), 6 * problem.body_count(),
                         std::move(entries));
}

std::string system_text(const StepProblem& problem, const StoredPartition*) {
  std::vector<int> rows(static_cast<std::size_t>(problem.row_count()));
  std::iota(rows.begin(), rows.end(), 0);
  const int size = 6 * problem.body_count();
  return coordinate_text("symmetric", "H = M + J^T C^-1 J over all rows", size, size,
                         system_entries(problem, rows));
}

std::string interface_text(const StepProblem& problem, const StoredPartition* partition) {
  const int size = static_cast<int>(interface_rows(problem, partition->part_of_body).size());
  return coordinate_text("symmetric", "S, Schur complement over the interface rows of a partition", size,
                         size, interface_entries(problem, partition->part_of_body));
}

constexpr MatrixOfProblem kMatrices[] = {
    {"M", "mass", false, mass_text},
    {"J", "Jacobian", false, jacobian_text},
    {"H", "M + J^T C^-1 J over all rows", false, system_text},
    {"S", "Schur complement over the interface rows of --partition", true, interface_text}};

}  // namespace

std::span<const MatrixOfProblem> matrices_of_problem() { return kMatrices; }

}  // namespace cleave
