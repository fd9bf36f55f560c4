#include "harness/files/problem_file_hashes.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "harness/base/hash.h"
#include "harness/base/numbers.h"
#include "harness/base/printable_text.h"
#include "harness/files/problem_file_fields.h"
#include "solver/problem_hash.h"

namespace cleave {
namespace {

// Names and lengths go in too, so that nothing can move from one member to the next.
class MemberHash {
 public:
  template <class Value>
  void operator()(std::string_view name, const Value& value) {
    add(name);
    add(value);
  }
  std::string text() const { return hex(hash_.value()); }

 private:
  void add(std::string_view text) {
    add(std::uint64_t{text.size()});
    hash_.add(text);
  }
  template <class Value>
  void add(const Value& value) {
    if constexpr (std::is_convertible_v<Value, std::string_view>) {
      add(std::string_view(value));
    } else if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
      hash_.add(std::span(&value, 1));
    } else {
      add(std::uint64_t{value.size()});
      hash_.add(value);
    }
  }
  Fnv1a64 hash_;
};

std::string description_hash(const ProblemFile& file) {
  MemberHash hash;
  visit_attributes(file, [&](const char* name, const auto& value, Presence) { hash(name, value); });
  hash("position", file.position);
  hash("orientation", file.orientation);
  if (file.body_group) hash("body_group", *file.body_group);
  if (file.shapes)
    visit_shape_arrays(*file.shapes, 0, 0,
                       [&](const char* name, const auto& values, const Hdf5Shape&) { hash(name, values); });
  return hash.text();
}

std::vector<StoredParameter> in_file_order(const std::vector<StoredParameter>& parameters) {
  std::vector<StoredParameter> stored;
  for (const StoredParameter& parameter : parameters) stored.push_back(as_stored(parameter));
  std::ranges::sort(stored, {}, &StoredParameter::name);
  return stored;
}

std::string solutions_hash(const ProblemFile& file) {
  MemberHash hash;
  const auto member = [&hash](const char* name, const auto& value) { hash(name, value); };
  for (const auto& [label, solution] : file.solutions) {
    hash("solution", label);
    visit_solution_attributes(solution, member);
    hash("impulse", solution.impulse);
    hash("velocity", solution.velocity);
  }
  for (const auto& [label, partition] : file.partitions) {
    hash("partition", label);
    visit_partition_attributes(partition, member);
    for (const StoredParameter& parameter : in_file_order(partition.parameters)) {
      hash(parameter.name, parameter.text);
      hash("kind", parameter.kind);
    }
    hash("part_of_body", partition.part_of_body);
    if (!partition.parent_of_part.empty()) hash("parent_of_part", partition.parent_of_part);
  }
  return hash.text();
}

bool has_none(const StoredHashes& stored) {
  return stored.problem.empty() && stored.description.empty() && stored.solutions.empty();
}

}  // namespace

StoredHashes hashes_of(const ProblemFile& file) {
  return {kWrittenByCleave, hex(problem_hash(file.problem)), description_hash(file), solutions_hash(file)};
}

StoredParameter as_stored(const StoredParameter& parameter) {
  using Kind = Parameter::Kind;
  switch (parameter.kind) {
    case Kind::integer:
      return {parameter.name, Kind::integer,
              std::to_string(parse_integer(parameter.name, parameter.text, {}))};
    case Kind::number:
      return {parameter.name, Kind::number, number_text(parse_number(parameter.name, parameter.text, {}))};
    case Kind::flag:
      return {parameter.name, Kind::flag, parameter.text == "true" ? "true" : "false"};
    default:
      return {parameter.name, Kind::word, parameter.text};
  }
}

std::string find_hash_error(const ProblemFile& file, const StoredHashes& stored) {
  if (stored.written_by != kWrittenByCleave && has_none(stored)) return {};
  const StoredHashes found = hashes_of(file);
  std::string values[4], error;
  int next = 0;
  visit_hashes(found, [&](const char*, const std::string& value) { values[next++] = value; });
  next = 0;
  visit_hashes(stored, [&](const char* name, const std::string& value) {
    const std::string& expected = values[next++];
    if (!error.empty() || value == expected) return;
    if (value.empty())
      error = std::string("attribute ") + name + " is missing, which every file has that cleave wrote";
    else
      error = std::string(name) + " = \"" + printable(value) + "\", allowed: \"" + expected +
              "\", as its contents give";
    error += ": it is damaged, or was changed after it was written";
  });
  return error;
}

}  // namespace cleave
