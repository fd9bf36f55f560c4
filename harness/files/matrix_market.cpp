#include "harness/files/matrix_market.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "harness/base/numbers.h"

namespace cleave {
namespace {

struct Entry {
  int row, column;
  double value;
};

// Entries at one place are summed in the order in which they came.
std::string coordinate_text(const std::string& symmetry, const std::string& comment, int rows, int columns,
                            std::vector<Entry> entries) {
  const auto place = [](const Entry& entry) { return std::tuple(entry.column, entry.row); };
  std::ranges::stable_sort(entries, {}, place);
  std::string lines;
  int count = 0;
  for (std::size_t k = 0; k < entries.size();) {
    double sum = 0;
    const Entry& first = entries[k];
    for (; k < entries.size() && place(entries[k]) == place(first); ++k) sum += entries[k].value;
    if (sum == 0) continue;
    lines += std::to_string(first.row + 1) + " " + std::to_string(first.column + 1) + " " + number_text(sum) +
             "\n";
    ++count;
  }
  return "%%MatrixMarket matrix coordinate real " + symmetry + "\n% " + comment + "\n" +
         std::to_string(rows) + " " + std::to_string(columns) + " " + std::to_string(count) + "\n" + lines;
}

std::vector<Entry> lower_mass(const StepProblem& problem) {
  std::vector<Entry> entries;
  for (int body = 0; body < problem.body_count(); ++body)
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b <= a; ++b)
        entries.push_back({6 * body + a, 6 * body + b, problem.mass[36 * std::size_t(body) + 6 * a + b]});
  return entries;
}

// The at most twelve entries of a row of J.
std::vector<Entry> row_of_jacobian(const StepProblem& problem, int row) {
  std::vector<Entry> entries;
  for (int side = 0; side < 2; ++side) {
    const int body = problem.row_body[2 * std::size_t(row) + side];
    for (int k = 0; body >= 0 && k < 6; ++k)
      entries.push_back({row, 6 * body + k, problem.jacobian[12 * std::size_t(row) + 6 * side + k]});
  }
  return entries;
}

std::string mass_text(const StepProblem& problem) {
  const int size = 6 * problem.body_count();
  return coordinate_text("symmetric", "M, mass", size, size, lower_mass(problem));
}

std::string jacobian_text(const StepProblem& problem) {
  std::vector<Entry> entries;
  for (int row = 0; row < problem.row_count(); ++row)
    std::ranges::copy(row_of_jacobian(problem, row), std::back_inserter(entries));
  return coordinate_text("general", "J, Jacobian", problem.row_count(), 6 * problem.body_count(),
                         std::move(entries));
}

std::string system_text(const StepProblem& problem) {
  std::vector<Entry> entries = lower_mass(problem);
  for (int row = 0; row < problem.row_count(); ++row) {
    if (problem.compliance[row] <= 0)
      throw std::invalid_argument("--matrix: H is M + J^T C^-1 J, and compliance of row " +
                                  std::to_string(row) + " = 0, allowed: > 0");
    const std::vector<Entry> jacobian = row_of_jacobian(problem, row);
    for (const Entry& a : jacobian)
      for (const Entry& b : jacobian)
        if (a.column >= b.column)
          entries.push_back({a.column, b.column, a.value * b.value / problem.compliance[row]});
  }
  const int size = 6 * problem.body_count();
  return coordinate_text("symmetric", "H = M + J^T C^-1 J over all rows", size, size, std::move(entries));
}

constexpr MatrixOfProblem kMatrices[] = {{"M", "mass", mass_text},
                                         {"J", "Jacobian", jacobian_text},
                                         {"H", "M + J^T C^-1 J over all rows", system_text}};

}  // namespace

std::span<const MatrixOfProblem> matrices_of_problem() { return kMatrices; }

}  // namespace cleave
