#include "harness/files/fclib_file_check.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "harness/base/numbers.h"

namespace cleave {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& value, const std::string& allowed) {
  throw std::invalid_argument("fclib_global/" + what + " = " + value + ", allowed: " + allowed);
}

std::string at(const std::string& array, std::size_t index) {
  return array + "[" + std::to_string(index) + "]";
}

void expect_size(const std::string& name, std::size_t size, std::size_t expected) {
  if (size != expected) refuse("length of " + name, std::to_string(size), std::to_string(expected));
}

// lines: columns where nz = -1, rows where it is -2.
std::vector<MatrixEntry> compressed_entries(const std::string& name, const StoredFclibMatrix& stored) {
  const bool by_columns = stored.nz == kFclibColumns;
  const int lines = by_columns ? stored.n : stored.m, across = by_columns ? stored.m : stored.n;
  expect_size(name + "/p", stored.p.size(), static_cast<std::size_t>(lines) + 1);
  expect_size(name + "/i", stored.i.size(), static_cast<std::size_t>(stored.nzmax));
  std::vector<MatrixEntry> entries;
  for (int line = 0; line <= lines; ++line) {
    const int first = line == 0 ? 0 : stored.p[line - 1], last = stored.p[line];
    if (last < first || last > stored.nzmax || (line == 0 && last != 0))
      refuse(at(name + "/p", line), std::to_string(last),
             line == 0 ? "0" : std::to_string(first) + " to " + std::to_string(stored.nzmax));
    for (int k = first; k < last; ++k) {
      const int other = stored.i[k];
      if (other < 0 || other >= across)
        refuse(at(name + "/i", k), std::to_string(other), "0 to " + std::to_string(across - 1));
      entries.push_back({by_columns ? other : line - 1, by_columns ? line - 1 : other, stored.x[k]});
    }
  }
  return entries;
}

bool fits(const std::vector<int>& indices, int extent) {
  return std::ranges::all_of(indices, [extent](int index) { return index >= 0 && index < extent; });
}

std::vector<MatrixEntry> triplet_entries(const std::string& name, const StoredFclibMatrix& stored) {
  const std::size_t count = static_cast<std::size_t>(stored.nz);
  expect_size(name + "/p", stored.p.size(), count);
  expect_size(name + "/i", stored.i.size(), count);
  if (stored.nz > stored.nzmax)
    refuse(name + "/nz", std::to_string(stored.nz), "at most nzmax = " + std::to_string(stored.nzmax));
  const bool rows_first = fits(stored.p, stored.m) && fits(stored.i, stored.n);
  const bool columns_first = fits(stored.i, stored.m) && fits(stored.p, stored.n);
  if (!rows_first && !columns_first)
    refuse(name + "/p and i", "indices beyond the matrix", "rows below m and columns below n");
  if (rows_first && columns_first && name != "M" && count > 0)
    refuse(name + "/p and i", "triplets that may be rows and columns as well as columns and rows",
           "compressed columns, nz = -1, or compressed rows, nz = -2");
  std::vector<MatrixEntry> entries;
  for (std::size_t k = 0; k < count; ++k)
    entries.push_back(rows_first ? MatrixEntry{stored.p[k], stored.i[k], stored.x[k]}
                                 : MatrixEntry{stored.i[k], stored.p[k], stored.x[k]});
  return entries;
}

FclibMatrix checked_matrix(const std::string& name, const StoredFclibMatrix& stored) {
  if (stored.m < 0) refuse(name + "/m", std::to_string(stored.m), "0 or more");
  if (stored.n < 0) refuse(name + "/n", std::to_string(stored.n), "0 or more");
  if (stored.nzmax < 0) refuse(name + "/nzmax", std::to_string(stored.nzmax), "0 or more");
  if (stored.nz < kFclibRows) refuse(name + "/nz", std::to_string(stored.nz), "-2 or more");
  expect_size(name + "/x", stored.x.size(), static_cast<std::size_t>(stored.nzmax));
  for (std::size_t k = 0; k < stored.x.size(); ++k)
    if (!std::isfinite(stored.x[k])) refuse(at(name + "/x", k), number_text(stored.x[k]), "finite numbers");
  FclibMatrix matrix{stored.m, stored.n,
                     stored.nz < 0 ? compressed_entries(name, stored) : triplet_entries(name, stored)};
  sum_entries(matrix.entries);
  return matrix;
}

void check_vector(const std::string& name, const std::vector<double>& values, std::size_t size) {
  expect_size("vectors/" + name, values.size(), size);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!std::isfinite(values[k])) refuse(at("vectors/" + name, k), number_text(values[k]), "finite numbers");
}

}  // namespace

// What must fit together, of what the child handed back, whatever that is.
FclibGlobal checked_fclib(const StoredFclib& stored) {
  FclibGlobal global = stored.rest;
  if (global.dimension != 2 && global.dimension != 3)
    refuse("spacedim", std::to_string(global.dimension), "2, 3");
  global.M = checked_matrix("M", stored.M);
  global.H = checked_matrix("H", stored.H);
  global.G = checked_matrix("G", stored.G);
  const std::string unknowns = std::to_string(global.M.rows);
  if (global.M.columns != global.M.rows) refuse("M/n", std::to_string(global.M.columns), unknowns);
  if (global.H.rows != global.M.rows) refuse("H/m", std::to_string(global.H.rows), unknowns);
  if (global.G.rows != global.M.rows) refuse("G/m", std::to_string(global.G.rows), unknowns);
  if (global.H.columns % global.dimension != 0)
    refuse("H/n", std::to_string(global.H.columns),
           "a multiple of spacedim = " + std::to_string(global.dimension));
  check_vector("f", global.f, global.M.rows);
  check_vector("w", global.w, global.H.columns);
  check_vector("mu", global.mu, global.H.columns / global.dimension);
  check_vector("b", global.b, global.G.columns);
  for (std::size_t c = 0; c < global.mu.size(); ++c)
    if (global.mu[c] < 0) refuse(at("vectors/mu", c), number_text(global.mu[c]), "0 or more");
  return global;
}

}  // namespace cleave
