#include "solver/problem_hash.h"

#include "harness/base/hash.h"

namespace cleave {

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
  hash.add(problem.box_angle_rad);
  hash.add(problem.contact_set);
  return hash.value();
}

std::uint64_t solution_hash(std::span<const double> impulse, std::span<const int> part_of_body) {
  Fnv1a64 hash;
  hash.add(impulse);
  hash.add(part_of_body);
  return hash.value();
}

}  // namespace cleave
