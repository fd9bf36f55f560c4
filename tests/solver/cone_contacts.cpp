#include "tests/solver/cone_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/solver/problem_makers.h"
#include "tests/solver/seeded_random.h"
#include "tests/solver/turned_boxes.h"

namespace cleave {

StepProblem make_block(const Block& block) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 1, {1, 1, 1},
              {block.free_velocity[1], block.free_velocity[2], block.free_velocity[0], 0, 0, 0});
  for (int k = 0; k <= block.tangents; ++k) {
    RowSpec row;
    row.jacobian_a[(k + 2) % 3] = 1;
    row.rhs = block.rhs[k];
    row.compliance = block.compliance[k];
    row.kind = k == 0 ? RowKind::normal : RowKind::friction;
    row.friction_row = k == 0 ? -1 : 0;
    row.friction_coefficient = k == 0 ? 0 : block.mu;
    if (k == 0) row.lower = 0;
    append_row(problem, row);
  }
  problem.contact_set.assign(problem.row_count(), ContactSet::box);
  problem.contact_set[0] = block.set;
  return problem;
}

Paper make_paper(ContactSet set, double angle, double speed, double mu, int tangents) {
  const double c = tangents == 1 ? 1 : std::cos(angle), s = tangents == 1 ? 0 : std::sin(angle);
  Block block{{-kPush, speed * c, speed * s}, {}, {kCompliance, kCompliance, kCompliance}, mu, set, tangents};
  const double a = 1 + kCompliance;  // of every row: w = v0 + a lambda
  double normal = kPush / a, friction = speed / a;
  if (friction > mu * normal && set == ContactSet::cone) normal = (kPush + mu * speed) / (a * (1 + mu * mu));
  friction = std::min(friction, mu * normal);
  Paper paper{make_block(block), {normal, -friction * c, -friction * s}};
  paper.impulse.resize(1 + tangents);
  return paper;
}

StepProblem with_sets(StepProblem problem, ContactSet set, double share, std::uint64_t seed) {
  SeededRandom random(seed);
  problem.contact_set.assign(problem.row_count(), ContactSet::box);
  for (const int r : contacts_of(problem)) {
    if (!random.chance(share)) continue;
    problem.contact_set[r] = set;
    for (int k = r + 1; k <= r + 2; ++k) {
      problem.upper[k] = std::numeric_limits<double>::infinity();
      problem.lower[k] = -problem.upper[k];
    }
  }
  return problem;
}

StepProblem make_cone_pile(std::uint64_t seed, double cfm, ContactSet set) {
  StepProblem problem = make_turned_pile(seed, cfm);
  problem.box_angle_rad.clear();
  return with_sets(std::move(problem), set);
}

}  // namespace cleave
