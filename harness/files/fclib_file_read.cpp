#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "harness/base/refusals.h"
#include "harness/files/fclib_file.h"
#include "harness/files/fclib_file_check.h"
#include "harness/files/hdf5_reader.h"
#include "harness/files/isolated_read.h"
#include "harness/files/packed_bytes.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

void walk_optional(const auto& value, Packer& to) {
  to(value.has_value());
  if (value) to(*value);
}
void walk_optional(auto& value, Unpacker& from) {
  char is_there = 0;
  from(is_there);
  if (is_there != 0) from(value.emplace());
}

template <class Stored, class Stream>
void walk(Stored& stored, Stream& stream) {
  for (auto* matrix : {&stored.M, &stored.H, &stored.G}) {
    for (auto* number : {&matrix->m, &matrix->n, &matrix->nz, &matrix->nzmax}) stream(*number);
    stream(matrix->p);
    stream(matrix->i);
    stream(matrix->x);
  }
  stream(stored.rest.dimension);
  for (auto* vector : {&stored.rest.f, &stored.rest.w, &stored.rest.mu, &stored.rest.b}) stream(*vector);
  walk_optional(stored.rest.bodies, stream);
  walk_optional(stored.rest.h_s, stream);
}

int read_number(const Hdf5Reader& group, const char* name) {
  std::vector<int> value;
  group.array(name, {1}, value);
  return value.front();
}

// How many entries p and i have; negative numbers, refused later, have none.
StoredFclibMatrix read_matrix(const Hdf5Reader& group) {
  StoredFclibMatrix matrix{read_number(group, "m"),
                           read_number(group, "n"),
                           read_number(group, "nz"),
                           read_number(group, "nzmax"),
                           {},
                           {},
                           {}};
  const auto size = [](int number) { return static_cast<std::size_t>(std::max(number, 0)); };
  const bool is_compressed = matrix.nz == kFclibColumns || matrix.nz == kFclibRows;
  group.array("p",
              {is_compressed ? size(matrix.nz == kFclibColumns ? matrix.n : matrix.m) + 1 : size(matrix.nz)},
              matrix.p);
  group.array("i", {size(is_compressed ? matrix.nzmax : matrix.nz)}, matrix.i);
  group.array("x", {size(matrix.nzmax)}, matrix.x);
  return matrix;
}

void read_vector(const Hdf5Reader& group, const char* name, std::vector<double>& values) {
  group.array(name, {group.length(name)}, values);
}

StoredFclib read_contents(const Hdf5Reader& file) {
  if (!file.has("fclib_global"))
    file.fail(
        file.has("fclib_local")
            ? "fclib_local = the local form, in which W has taken the place of the bodies, allowed: the "
              "global form, a group fclib_global"
            : "group fclib_global is missing");
  const Hdf5Reader global = file.group("fclib_global");
  StoredFclib stored;
  stored.rest.dimension = read_number(global, "spacedim");
  stored.M = read_matrix(global.group("M"));
  stored.H = read_matrix(global.group("H"));
  const Hdf5Reader vectors = global.group("vectors");
  read_vector(vectors, "f", stored.rest.f);
  read_vector(vectors, "w", stored.rest.w);
  read_vector(vectors, "mu", stored.rest.mu);
  stored.G.m = stored.M.m;
  stored.G.p = {0};
  if (global.has("G")) {
    stored.G = read_matrix(global.group("G"));
    read_vector(vectors, "b", stored.rest.b);
  }
  if (global.has_attribute("cleave_bodies")) global.attribute("cleave_bodies", stored.rest.bodies.emplace());
  if (global.has_attribute("cleave_h_s")) global.attribute("cleave_h_s", stored.rest.h_s.emplace());
  return stored;
}

// What the child does.
std::string read_packed(const fs::path& path) {
  const Hdf5Reader reader(path);
  forbid_opening_files();
  try {
    const StoredFclib stored = read_contents(reader);
    Packer to;
    walk(stored, to);
    return std::move(to.bytes);
  } catch (const std::bad_alloc&) {
    reader.fail("does not fit into memory");
  }
}

}  // namespace

FclibGlobal read_fclib_file(const fs::path& path) {
  const std::string bytes =
      read_in_child(path.string(), read_limits(path), [&path] { return read_packed(path); });
  return in_context(path.string(), [&] {
    StoredFclib stored;
    Unpacker from(bytes);
    walk(stored, from);
    from.expect_end();
    return checked_fclib(stored);
  });
}

}  // namespace cleave
