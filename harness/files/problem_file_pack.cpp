#include "harness/files/problem_file_pack.h"

#include "harness/files/packed_bytes.h"
#include "harness/files/problem_file_fields.h"

namespace cleave {
namespace {

// Walks a file in the order in which its members are packed. Stream: Packer with const files, or Unpacker.
template <class Shapes, class Stream>
void walk_shapes(Shapes& shapes, Stream& stream) {
  visit_shape_arrays(shapes, 0, 0, [&](const char*, auto& values, const Hdf5Shape&) { stream(values); });
}

template <class Solution, class Stream>
void walk_solution(Solution& solution, Stream& stream) {
  visit_solution_attributes(solution, [&](const char*, auto& value) { stream(value); });
  stream(solution.impulse);
  stream(solution.velocity);
}

template <class Parameter, class Stream>
void walk_parameter(Parameter& parameter, Stream& stream) {
  stream(parameter.name);
  stream(parameter.kind);
  stream(parameter.text);
}

template <class Partition, class Stream>
void walk_partition(Partition& partition, Stream& stream) {
  visit_partition_attributes(partition, [&](const char*, auto& value) { stream(value); });
  stream(partition.part_of_body);
  stream(partition.parent_of_part);
}

template <class Packed, class Stream>
void walk_plain(Packed& packed, Stream& stream) {
  visit_hashes(packed.hashes, [&](const char*, auto& value) { stream(value); });
  visit_attributes(packed.file, [&](const char*, auto& value, Presence) { stream(value); });
  visit_arrays(packed.file, 0, 0,
               [&](const char*, auto& values, const Hdf5Shape&, Presence) { stream(values); });
  stream(packed.file.problem.contact_set);
}

void unpack_partition(Unpacker& from, StoredPartition& partition) {
  walk_partition(partition, from);
  for (std::size_t count = from.count(1); count > 0; --count)
    walk_parameter(partition.parameters.emplace_back(), from);
}

// Sizes, which nothing after this looks at again.
void expect_sizes(const ProblemFile& file) {
  const std::size_t n = file.problem.body_count(), m = file.problem.row_count();
  const auto expect = [](const char*, const auto& values, const Hdf5Shape& shape, auto...) {
    std::size_t count = 1;
    for (const std::size_t extent : shape) count *= extent;
    if (values.size() != count) Unpacker::fail();
  };
  visit_arrays(file, n, m, expect);
  if (!file.problem.contact_set.empty()) expect("", file.problem.contact_set, {m});
  if (file.body_group) expect("", *file.body_group, {n});
  if (file.shapes)
    visit_shape_arrays(*file.shapes, file.shapes->geom_body.size(), file.shapes->convex_points.size() / 3,
                       expect);
  for (const auto& [label, solution] : file.solutions) {
    expect("", solution.impulse, {m});
    expect("", solution.velocity, {n, 6});
  }
  for (const auto& [label, partition] : file.partitions) expect("", partition.part_of_body, {n});
}

}  // namespace

std::string pack(const PackedProblemFile& packed) {
  const ProblemFile& file = packed.file;
  Packer to;
  walk_plain(packed, to);
  to(file.body_group.has_value());
  if (file.body_group) to(*file.body_group);
  to(file.shapes.has_value());
  if (file.shapes) walk_shapes(*file.shapes, to);
  to(file.solutions.size());
  for (const auto& [label, solution] : file.solutions) {
    to(label);
    walk_solution(solution, to);
  }
  to(file.partitions.size());
  for (const auto& [label, partition] : file.partitions) {
    to(label);
    walk_partition(partition, to);
    to(partition.parameters.size());
    for (const StoredParameter& parameter : partition.parameters) walk_parameter(parameter, to);
  }
  return std::move(to.bytes);
}

PackedProblemFile unpack(std::string_view bytes) {
  PackedProblemFile packed;
  ProblemFile& file = packed.file;
  Unpacker from(bytes);
  walk_plain(packed, from);
  const auto is_there = [&from] {
    char there = 0;
    from(there);
    return there != 0;
  };
  if (is_there()) from(file.body_group.emplace());
  if (is_there()) walk_shapes(file.shapes.emplace(), from);
  const auto label = [&from] {
    std::string text;
    from(text);
    return text;
  };
  for (std::size_t count = from.count(1); count > 0; --count) walk_solution(file.solutions[label()], from);
  for (std::size_t count = from.count(1); count > 0; --count)
    unpack_partition(from, file.partitions[label()]);
  from.expect_end();
  expect_sizes(file);
  return packed;
}

}  // namespace cleave
