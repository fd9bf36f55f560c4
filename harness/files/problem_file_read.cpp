#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>

#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/files/hdf5_reader.h"
#include "harness/files/problem_file.h"
#include "harness/files/problem_file_defaults.h"
#include "harness/files/problem_file_fields.h"

namespace cleave {
namespace {

// Solvers index 36 numbers a body and 12 a row with int.
constexpr std::size_t kMostBodies = std::numeric_limits<int>::max() / 36;
constexpr std::size_t kMostRows = std::numeric_limits<int>::max() / 12;

std::string text_of(int value) { return std::to_string(value); }
std::string text_of(std::uint8_t value) { return std::to_string(value); }
std::string text_of(double value) { return number_text(value); }
std::string text_of(const std::string& value) { return '"' + value + '"'; }

// Throws "FILE: geom_type[3] = 9, allowed: 0 to 5".
template <class Value>
void require(bool allowed, const Hdf5Reader& reader, const std::string& name, const Value& value,
             const std::string& rule) {
  if (!allowed) reader.fail(reader.full(name) + " = " + text_of(value) + ", allowed: " + rule);
}

template <class Value, class Predicate>
void require_each(const Hdf5Reader& reader, const std::string& name, const std::vector<Value>& values,
                  Predicate allowed, const std::string& rule) {
  for (std::size_t i = 0; i < values.size(); ++i)
    require(allowed(values[i]), reader, name + "[" + std::to_string(i) + "]", values[i], rule);
}

bool is_finite(double value) { return std::isfinite(value); }
bool is_size(double value) { return std::isfinite(value) && value >= 0; }

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
  require(schema == kProblemSchema, reader, "schema", schema, text_of(kProblemSchema));
}

void read_experiment(const Hdf5Reader& reader, ProblemFile& file) {
  visit_attributes(file, present_attributes_of(reader));
  require(file.step >= 0, reader, "step", file.step, ">= 0");
  require(is_size(file.erp), reader, "erp", file.erp, "finite and >= 0");
  require(is_size(file.cfm), reader, "cfm", file.cfm, "finite and >= 0");
}

// Friction is part of the problem: where there is some, nothing about it has a default.
void check_friction(const Hdf5Reader& reader, const StepProblem& problem) {
  if (std::ranges::count(problem.row_kind, RowKind::friction) == 0) return;
  for (const char* name : {"friction_row", "friction_coefficient"})
    if (!reader.has(name))
      reader.fail(std::string("dataset ") + name + " is missing, which friction rows need");
}

void read_problem(const Hdf5Reader& reader, std::size_t n, std::size_t m, ProblemFile& file) {
  visit_arrays(file, n, m, present_arrays_of(reader));
  fill_left_out(file);
  check_friction(reader, file.problem);
  const std::string error = find_problem_error(file.problem);
  if (!error.empty()) reader.fail(error);
  require_each(reader, "position", file.position, is_finite, "finite numbers");
  require_each(reader, "orientation", file.orientation, is_finite, "finite numbers");
  if (reader.has("body_group")) reader.array("body_group", {n}, file.body_group.emplace());
}

void check_convex_first(const Hdf5Reader& reader, const std::vector<int>& first, int corners) {
  for (std::size_t i = 0; i < first.size(); ++i) {
    const int least = i == 0 ? 0 : first[i - 1];
    require(first[i] >= least && first[i] <= corners, reader, "convex_first[" + std::to_string(i) + "]",
            first[i], std::to_string(least) + " to " + std::to_string(corners));
  }
  require(first.front() == 0, reader, "convex_first[0]", first.front(), "0");
  require(first.back() == corners, reader, "convex_first[" + std::to_string(first.size() - 1) + "]",
          first.back(), std::to_string(corners) + ", the number of corners");
}

ProblemShapes read_shapes(const Hdf5Reader& reader, int bodies) {
  ProblemShapes shapes;
  const std::size_t g = read_length(reader, "geom_body", kMostRows);
  const std::size_t k = read_length(reader, "convex_points", kMostRows);
  visit_shape_arrays(shapes, g, k, arrays_of(reader));
  const auto is_body = [bodies](int body) { return body >= -1 && body < bodies; };
  const auto is_type = [](std::uint8_t type) { return type <= static_cast<std::uint8_t>(GeomType::plane); };
  require_each(reader, "geom_body", shapes.geom_body, is_body,
               "-1 (static) to " + std::to_string(bodies - 1));
  require_each(reader, "geom_type", shapes.geom_type, is_type,
               "0 (box), 1 (sphere), 2 (capsule), 3 (cylinder), 4 (convex), 5 (plane)");
  require_each(reader, "geom_size", shapes.geom_size, is_size, "finite and >= 0");
  require_each(reader, "geom_position", shapes.geom_position, is_finite, "finite numbers");
  require_each(reader, "geom_orientation", shapes.geom_orientation, is_finite, "finite numbers");
  require_each(reader, "convex_points", shapes.convex_points, is_finite, "finite numbers");
  check_convex_first(reader, shapes.convex_first, static_cast<int>(k));
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
  return partition;
}

ProblemFile read_contents(const Hdf5Reader& reader) {
  ProblemFile file;
  read_schema(reader);
  read_experiment(reader, file);
  const std::size_t n = read_length(reader, "free_velocity", kMostBodies);
  const std::size_t m = read_length(reader, "rhs", kMostRows);
  read_problem(reader, n, m, file);
  if (reader.has("shape")) file.shapes = read_shapes(reader.group("shape"), static_cast<int>(n));
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

}  // namespace

ProblemFile read_problem_file(const std::filesystem::path& path) {
  const Hdf5Reader reader(path);
  try {
    return read_contents(reader);
  } catch (const std::bad_alloc&) {
    reader.fail("does not fit into memory");
  }
}

}  // namespace cleave
