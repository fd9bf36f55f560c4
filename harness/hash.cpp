#include "harness/hash.h"

#include <bit>
#include <cstdio>

namespace cleave {

// The bytes in memory are hashed as they lie.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(int) == 4 && sizeof(double) == 8 && sizeof(RowKind) == 1);

void Fnv1a64::add_bytes(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3u;
}

void Fnv1a64::add(std::span<const double> values) { add_bytes(values.data(), values.size_bytes()); }
void Fnv1a64::add(std::span<const int> values) { add_bytes(values.data(), values.size_bytes()); }
void Fnv1a64::add(std::span<const RowKind> values) { add_bytes(values.data(), values.size_bytes()); }
void Fnv1a64::add(std::string_view text) { add_bytes(text.data(), text.size()); }

std::uint64_t problem_hash(const StepProblem& problem) {
  Fnv1a64 hash;
  hash.add(std::span(&problem.h_s, 1));
  hash.add(problem.mass);
  hash.add(problem.free_velocity);
  hash.add(problem.row_body);
  hash.add(problem.jacobian);
  hash.add(problem.rhs);
  hash.add(problem.compliance);
  hash.add(problem.lower);
  hash.add(problem.upper);
  hash.add(problem.row_kind);
  hash.add(problem.friction_row);
  hash.add(problem.friction_coefficient);
  hash.add(problem.row_constraint);
  hash.add(problem.contact_point);
  hash.add(problem.warm_impulse);
  return hash.value();
}

std::uint64_t solution_hash(std::span<const double> impulse, std::span<const int> part_of_body) {
  Fnv1a64 hash;
  hash.add(impulse);
  hash.add(part_of_body);
  return hash.value();
}

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

}  // namespace cleave
