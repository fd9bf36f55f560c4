#include "solver/problem_hash.h"

#include "harness/base/hash.h"
#include "solver/row_arrays.h"

namespace cleave {

std::uint64_t problem_hash(const StepProblem& problem) {
  Fnv1a64 hash;
  hash.add(std::span(&problem.h_s, 1));
  hash.add(problem.mass);
  hash.add(problem.free_velocity);
  visit_row_arrays([&](const char*, auto member, std::size_t, RowArray) { hash.add(problem.*member); });
  return hash.value();
}

std::uint64_t solution_hash(std::span<const double> impulse, std::span<const int> part_of_body) {
  Fnv1a64 hash;
  hash.add(impulse);
  hash.add(part_of_body);
  return hash.value();
}

}  // namespace cleave
