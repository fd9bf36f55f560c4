#include "tests/solver/problem_makers.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace cleave {

int append_row(StepProblem& problem, const RowSpec& row) {
  problem.row_body.insert(problem.row_body.end(), {row.body_a, row.body_b});
  problem.jacobian.insert(problem.jacobian.end(), row.jacobian_a.begin(), row.jacobian_a.end());
  problem.jacobian.insert(problem.jacobian.end(), row.jacobian_b.begin(), row.jacobian_b.end());
  problem.rhs.push_back(row.rhs);
  problem.compliance.push_back(row.compliance);
  problem.lower.push_back(row.lower);
  problem.upper.push_back(row.upper);
  problem.row_kind.push_back(row.kind);
  problem.friction_row.push_back(row.friction_row);
  problem.friction_coefficient.push_back(row.friction_coefficient);
  problem.row_constraint.push_back(row.constraint);
  problem.contact_point.insert(problem.contact_point.end(), row.point.begin(), row.point.end());
  problem.warm_impulse.push_back(0);
  return problem.row_count() - 1;
}

int append_body(StepProblem& problem, double mass_kg, const Vec3& inertia_kg_m2,
                const std::array<double, 6>& velocity) {
  std::array<double, 36> block{};
  for (int k = 0; k < 3; ++k) {
    block[7 * k] = mass_kg;
    block[7 * (k + 3)] = inertia_kg_m2[k];
  }
  problem.mass.insert(problem.mass.end(), block.begin(), block.end());
  problem.free_velocity.insert(problem.free_velocity.end(), velocity.begin(), velocity.end());
  return problem.body_count() - 1;
}

std::vector<int> single_part(int bodies) { return std::vector<int>(bodies, 0); }

std::vector<int> own_parts(int bodies) {
  std::vector<int> parts(bodies);
  std::iota(parts.begin(), parts.end(), 0);
  return parts;
}

std::vector<int> sliced_parts(int bodies, int parts) {
  std::vector<int> part_of_body(bodies);
  for (int i = 0; i < bodies; ++i) part_of_body[i] = i * parts / bodies;
  return part_of_body;
}

std::vector<int> random_parts(SeededRandom& random, int bodies, int parts) {
  std::vector<int> part_of_body(bodies);
  for (int i = 0; i < bodies; ++i) part_of_body[i] = i < parts ? i : random.integer(0, parts - 1);
  for (int i = bodies - 1; i > 0; --i) std::swap(part_of_body[i], part_of_body[random.integer(0, i)]);
  return part_of_body;
}

int count_cut_rows(const StepProblem& problem, const std::vector<int>& part_of_body) {
  int cut = 0;
  for (int r = 0; r < problem.row_count(); ++r) {
    const int a = problem.row_body[2 * r];
    const int b = problem.row_body[2 * r + 1];
    if (b >= 0 && part_of_body[a] != part_of_body[b]) ++cut;
  }
  return cut;
}

}  // namespace cleave
