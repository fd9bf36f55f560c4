#include <algorithm>
#include <cstdio>
#include <limits>
#include <new>
#include <set>
#include <stdexcept>
#include <utility>

#include "harness/base/printable_text.h"
#include "harness/base/refusals.h"
#include "harness/files/hdf5_reader.h"
#include "harness/files/isolated_read.h"
#include "harness/files/problem_file.h"
#include "harness/files/problem_file_check.h"
#include "harness/files/problem_file_defaults.h"
#include "harness/files/problem_file_fields.h"
#include "harness/files/problem_file_hashes.h"
#include "harness/files/problem_file_pack.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

// Solvers index 36 numbers a body and 12 a row with int.
constexpr std::size_t kMostBodies = std::numeric_limits<int>::max() / 36;
constexpr std::size_t kMostRows = std::numeric_limits<int>::max() / 12;

std::size_t read_length(const Hdf5Reader& reader, const char* dataset, std::size_t most) {
  const std::size_t length = reader.length(dataset);
  if (length > most)
    reader.fail("length of " + reader.full(dataset) + " = " + std::to_string(length) + ", allowed: 0 to " +
                std::to_string(most));
  return length;
}

// Visitors that read a member of the same name.
auto attributes_of(const Hdf5Reader& reader) {
  return [&reader](const char* name, auto& value) { reader.attribute(name, value); };
}
auto arrays_of(const Hdf5Reader& reader) {
  return [&reader](const char* name, auto& values, const Hdf5Shape& shape) {
    reader.array(name, shape, values);
  };
}

// The same for members that a file may leave alone: they keep the value they have.
auto present_attributes_of(const Hdf5Reader& reader) {
  return [&reader](const char* name, auto& value, Presence presence) {
    if (presence == Presence::required || reader.has_attribute(name)) reader.attribute(name, value);
  };
}
auto present_arrays_of(const Hdf5Reader& reader) {
  return [&reader](const char* name, auto& values, const Hdf5Shape& shape, Presence presence) {
    if (presence == Presence::required || reader.has(name)) reader.array(name, shape, values);
  };
}

void read_schema(const Hdf5Reader& reader) {
  std::string schema;
  reader.attribute("schema", schema);
  if (schema != kProblemSchema && schema != kProblemSchemaWithSets)
    reader.fail("schema = \"" + printable(schema) + "\", allowed: \"" + kProblemSchema + "\", \"" +
                kProblemSchemaWithSets + '"');
  if (reader.has("contact_set") != (schema == kProblemSchemaWithSets))
    reader.fail("schema = \"" + schema + "\", allowed: \"" + kProblemSchemaWithSets +
                "\" where there is a contact_set, \"" + kProblemSchema + "\" where there is none");
}

void read_hashes(const Hdf5Reader& reader, StoredHashes& hashes) {
  visit_hashes(hashes, [&reader](const char* name, std::string& value) {
    if (reader.has_attribute(name)) reader.attribute(name, value);
  });
}

// Friction is part of the problem: where there is some, nothing about it has a default.
void check_friction(const Hdf5Reader& reader, const StepProblem& problem) {
  if (std::ranges::count(problem.row_kind, RowKind::friction) == 0) return;
  for (const char* name : {"friction_row", "friction_coefficient"})
    if (!reader.has(name))
      reader.fail(std::string("dataset ") + name + " is missing, which friction rows need");
}

// A file of ours holds nothing that is not read: the name of an array with a default may have been damaged.
void check_members(const Hdf5Reader& reader, const StoredHashes& hashes) {
  std::set<std::string> known = {"contact_set", "body_group", "shape", "solution", "partition"};
  ProblemFile any;
  visit_arrays(any, 0, 0, [&known](const char* name, auto&&...) { known.insert(name); });
  for (const std::string& name : reader.names())
    if (hashes.written_by == kWrittenByCleave && !known.contains(name))
      reader.fail(name + " is no data of a problem file that cleave wrote: the file is damaged");
}

void read_problem(const Hdf5Reader& reader, std::size_t n, std::size_t m, ProblemFile& file) {
  visit_arrays(file, n, m, present_arrays_of(reader));
  fill_left_out(file);
  check_friction(reader, file.problem);
  if (reader.has("contact_set")) reader.array("contact_set", {m}, file.problem.contact_set);
  if (reader.has("body_group")) reader.array("body_group", {n}, file.body_group.emplace());
}

ProblemShapes read_shapes(const Hdf5Reader& reader) {
  ProblemShapes shapes;
  const std::size_t g = read_length(reader, "geom_body", kMostRows);
  const std::size_t k = read_length(reader, "convex_points", kMostRows);
  visit_shape_arrays(shapes, g, k, arrays_of(reader));
  return shapes;
}

StoredSolution read_solution(const Hdf5Reader& reader, std::size_t n, std::size_t m) {
  StoredSolution solution;
  visit_solution_attributes(solution, attributes_of(reader));
  reader.array("impulse", {m}, solution.impulse);
  reader.array("velocity", {n, 6}, solution.velocity);
  return solution;
}

StoredPartition read_partition(const Hdf5Reader& reader, std::size_t n) {
  StoredPartition partition;
  visit_partition_attributes(partition, attributes_of(reader));
  for (const std::string& name : reader.attribute_names()) {
    if (name == "partitioner" || name == "refiner") continue;
    partition.parameters.push_back({name, reader.attribute_kind(name), reader.attribute_text(name)});
  }
  reader.array("part_of_body", {n}, partition.part_of_body);
  if (reader.has("parent_of_part")) {
    const std::size_t nodes = read_length(reader, "parent_of_part", 2 * kMostBodies);
    reader.array("parent_of_part", {nodes}, partition.parent_of_part);
  }
  return partition;
}

ProblemFile read_contents(const Hdf5Reader& reader) {
  ProblemFile file;
  read_schema(reader);
  visit_attributes(file, present_attributes_of(reader));
  const std::size_t n = read_length(reader, "free_velocity", kMostBodies);
  const std::size_t m = read_length(reader, "rhs", kMostRows);
  read_problem(reader, n, m, file);
  if (reader.has("shape")) file.shapes = read_shapes(reader.group("shape"));
  if (reader.has("solution")) {
    const Hdf5Reader group = reader.group("solution");
    for (const std::string& label : group.names())
      file.solutions[label] = read_solution(group.group(label), n, m);
  }
  if (reader.has("partition")) {
    const Hdf5Reader group = reader.group("partition");
    for (const std::string& label : group.names())
      file.partitions[label] = read_partition(group.group(label), n);
  }
  return file;
}

// What the child does.
std::string read_packed(const fs::path& path) {
  const Hdf5Reader reader(path);
  forbid_opening_files();
  PackedProblemFile packed;
  try {
    read_hashes(reader, packed.hashes);
    check_members(reader, packed.hashes);
    packed.file = read_contents(reader);
    return pack(packed);
  } catch (const std::bad_alloc&) {
    reader.fail("does not fit into memory");
  }
}

// Checks what the child handed back, whatever that is.
ProblemFile checked_file(const std::string& bytes) {
  PackedProblemFile packed = unpack(bytes);
  std::string error = find_contents_error(packed.file);
  if (error.empty()) error = find_hash_error(packed.file, packed.hashes);
  if (!error.empty()) throw std::invalid_argument(error);
  packed.file.is_checked = !packed.hashes.problem.empty();
  return std::move(packed.file);
}

}  // namespace

ProblemFile read_problem_file(const fs::path& path) {
  const std::string bytes =
      read_in_child(path.string(), read_limits(path), [&path] { return read_packed(path); });
  return in_context(path.string(), [&] { return checked_file(bytes); });
}

ProblemFile read_problem_file_aloud(const fs::path& path) {
  ProblemFile file = read_problem_file(path);
  if (!file.is_checked)
    say(path.string() + ": unchecked: it carries no hashes that would tell a changed bit");
  return file;
}

}  // namespace cleave
