#include <algorithm>
#include <stdexcept>

#include "harness/hdf5_writer.h"
#include "harness/problem_file.h"
#include "harness/problem_file_fields.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

void write_solution(const Hdf5Writer& group, const StoredSolution& solution, std::size_t n) {
  visit_solution_attributes(solution,
                            [&](const char* name, const auto& value) { group.attribute(name, value); });
  group.array("impulse", {solution.impulse.size()}, solution.impulse);
  group.array("velocity", {n, 6}, solution.velocity);
}

void write_partition(const Hdf5Writer& group, const StoredPartition& partition) {
  visit_partition_attributes(partition,
                             [&](const char* name, const auto& value) { group.attribute(name, value); });
  for (const char* word : kPartitionWords)
    group.attribute(word, option_of_attribute(word).get(partition.options));
  group.array("part_of_body", {partition.part_of_body.size()}, partition.part_of_body);
}

void write_contents(const Hdf5Writer& writer, const ProblemFile& file) {
  const std::size_t n = file.problem.body_count(), m = file.problem.row_count();
  const auto array = [](const Hdf5Writer& group) {
    return [&group](const char* name, const auto& values, const Hdf5Shape& shape) {
      group.array(name, shape, values);
    };
  };
  writer.attribute("schema", kProblemSchema);
  visit_attributes(file, [&](const char* name, const auto& value) { writer.attribute(name, value); });
  visit_arrays(file, n, m, array(writer));
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

std::string combination_label(const std::string& partitioner, const std::string& refiner,
                              const std::string& solver) {
  return partitioner + "+" + refiner + "+" + solver;
}

const OptionSpec& option_of_attribute(const std::string& attribute) {
  std::string name = attribute;
  std::ranges::replace(name, '_', '-');
  return *std::ranges::find(run_option_specs(), name, &OptionSpec::name);
}

void write_problem_file(const fs::path& path, const ProblemFile& file) {
  const std::string error = find_problem_error(file.problem);
  if (!error.empty()) throw std::invalid_argument(path.string() + ": not written: " + error);
  const fs::path temporary = path.string() + ".part";
  try {
    Hdf5Writer writer(temporary);
    write_contents(writer, file);
    writer.close();
    fs::rename(temporary, path);
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

}  // namespace cleave
