#include <cstdio>
#include <stdexcept>

#include "harness/base/numbers.h"
#include "harness/files/hdf5_writer.h"
#include "harness/files/problem_file.h"
#include "harness/files/problem_file_check.h"
#include "harness/files/problem_file_fields.h"
#include "harness/files/problem_file_hashes.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

void write_solution(const Hdf5Writer& group, const StoredSolution& solution, std::size_t n) {
  visit_solution_attributes(solution,
                            [&](const char* name, const auto& value) { group.attribute(name, value); });
  group.array("impulse", {solution.impulse.size()}, solution.impulse);
  group.array("velocity", {n, 6}, solution.velocity);
}

// With the type of its kind, so that any reader gets a number for a number.
void write_parameter(const Hdf5Writer& group, const StoredParameter& parameter) {
  switch (parameter.kind) {
    case Parameter::Kind::integer:
      return group.attribute(parameter.name, parse_integer(parameter.name, parameter.text, {}));
    case Parameter::Kind::number:
      return group.attribute(parameter.name, parse_number(parameter.name, parameter.text, {}));
    case Parameter::Kind::flag:
      return group.attribute(parameter.name, parameter.text == "true");
    default:
      return group.attribute(parameter.name, parameter.text);
  }
}

void write_partition(const Hdf5Writer& group, const StoredPartition& partition) {
  visit_partition_attributes(partition,
                             [&](const char* name, const auto& value) { group.attribute(name, value); });
  for (const StoredParameter& parameter : partition.parameters) write_parameter(group, parameter);
  group.array("part_of_body", {partition.part_of_body.size()}, partition.part_of_body);
  if (!partition.parent_of_part.empty())
    group.array("parent_of_part", {partition.parent_of_part.size()}, partition.parent_of_part);
}

void write_contents(const Hdf5Writer& writer, const ProblemFile& file) {
  const std::size_t n = file.problem.body_count(), m = file.problem.row_count();
  const auto array = [](const Hdf5Writer& group) {
    return [&group](const char* name, const auto& values, const Hdf5Shape& shape) {
      group.array(name, shape, values);
    };
  };
  // First of all: an object header that is cut short still says that there were hashes.
  const StoredHashes hashes = hashes_of(file);
  visit_hashes(hashes, [&](const char* name, const std::string& value) { writer.attribute(name, value); });
  writer.attribute("schema", problem_schema(file.problem));
  visit_attributes(file,
                   [&](const char* name, const auto& value, Presence) { writer.attribute(name, value); });
  visit_arrays(file, n, m, [&](const char* name, const auto& values, const Hdf5Shape& shape, Presence) {
    writer.array(name, shape, values);
  });
  if (!file.problem.contact_set.empty()) writer.array("contact_set", {m}, file.problem.contact_set);
  if (file.body_group) writer.array("body_group", {n}, *file.body_group);
  if (file.shapes) {
    const Hdf5Writer group = writer.group("shape");
    visit_shape_arrays(*file.shapes, file.shapes->geom_body.size(), file.shapes->convex_points.size() / 3,
                       array(group));
  }
  if (!file.solutions.empty()) {
    const Hdf5Writer group = writer.group("solution");
    for (const auto& [label, solution] : file.solutions) write_solution(group.group(label), solution, n);
  }
  if (!file.partitions.empty()) {
    const Hdf5Writer group = writer.group("partition");
    for (const auto& [label, partition] : file.partitions) write_partition(group.group(label), partition);
  }
}

}  // namespace

void write_problem_file(const fs::path& path, const ProblemFile& file) {
  const std::string error = find_contents_error(file);
  if (!error.empty()) throw std::invalid_argument(path.string() + ": not written: " + error);
  if (!file.problem.box_angle_rad.empty())
    throw std::invalid_argument(path.string() + ": not written: the format has no place for box_angle_rad");
  Hdf5Writer writer(path);
  write_contents(writer, file);
  writer.close();
}

std::string problem_file_name(const std::string& scene, int step) {
  char number[16];
  std::snprintf(number, sizeof number, "%06d", step);
  return scene + "_step" + number + ".h5";
}

}  // namespace cleave
