#include "harness/files/fclib_file.h"
#include "harness/files/fclib_file_check.h"
#include "harness/files/hdf5_writer.h"

namespace cleave {
namespace {

void write_matrix(const Hdf5Writer& group, const FclibMatrix& matrix) {
  const std::size_t count = matrix.entries.size();
  std::vector<int> first(static_cast<std::size_t>(matrix.columns) + 1, 0), row;
  std::vector<double> value;
  for (const MatrixEntry& entry : matrix.entries) {
    ++first[entry.column + 1];
    row.push_back(entry.row);
    value.push_back(entry.value);
  }
  for (int c = 0; c < matrix.columns; ++c) first[c + 1] += first[c];
  const auto number = [&group](const char* name, int value) {
    group.array(name, {1}, std::vector<int>{value});
  };
  number("nzmax", static_cast<int>(count));
  number("m", matrix.rows);
  number("n", matrix.columns);
  number("nz", kFclibColumns);
  group.array("p", {first.size()}, first);
  group.array("i", {count}, row);
  group.array("x", {count}, value);
}

void write_global(const Hdf5Writer& group, const FclibGlobal& problem) {
  if (problem.bodies) group.attribute("cleave_bodies", *problem.bodies);
  if (problem.h_s) group.attribute("cleave_h_s", *problem.h_s);
  group.array("spacedim", {1}, std::vector<int>{problem.dimension});
  write_matrix(group.group("M"), problem.M);
  write_matrix(group.group("H"), problem.H);
  if (problem.G.columns > 0) write_matrix(group.group("G"), problem.G);
  const Hdf5Writer vectors = group.group("vectors");
  vectors.array("f", {problem.f.size()}, problem.f);
  vectors.array("w", {problem.w.size()}, problem.w);
  vectors.array("mu", {problem.mu.size()}, problem.mu);
  if (problem.G.columns > 0) vectors.array("b", {problem.b.size()}, problem.b);
}

}  // namespace

void write_fclib_file(const std::filesystem::path& path, const FclibGlobal& problem) {
  Hdf5Writer writer(path);
  write_global(writer.group("fclib_global"), problem);
  writer.close();
}

}  // namespace cleave
