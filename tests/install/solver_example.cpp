// Three boxes of 1, 10 and 100 kg on top of each other, at rest on the ground: one step of 10 ms, solved
// exactly.
#include <cstdio>
#include <limits>
#include <vector>

#include "solver/registry.h"
#include "solver/residual.h"

int main() {
  constexpr int kBoxes = 3;
  constexpr double kMassKg[kBoxes] = {1, 10, 100}, kGravity = 9.81;
  cleave::StepProblem problem;
  problem.h_s = 0.01;
  problem.mass.resize(36 * kBoxes);
  problem.jacobian.resize(12 * kBoxes);
  for (int box = 0; box < kBoxes; ++box) {  // and its one contact, with what lies below
    for (int i = 0; i < 6; ++i) problem.mass[36 * box + 7 * i] = i < 3 ? kMassKg[box] : kMassKg[box] / 6;
    problem.free_velocity.insert(problem.free_velocity.end(), {0, 0, -kGravity * problem.h_s, 0, 0, 0});
    problem.row_body.insert(problem.row_body.end(), {box, box - 1});  // -1: the ground
    problem.jacobian[12 * box + 2] = 1;
    if (box > 0) problem.jacobian[12 * box + 6 + 2] = -1;
    problem.contact_point.insert(problem.contact_point.end(), {0, 0, double(box)});
    problem.row_constraint.push_back(box);
  }
  problem.rhs = problem.compliance = problem.lower = problem.friction_coefficient = problem.warm_impulse =
      std::vector<double>(kBoxes, 0.0);
  problem.upper.assign(kBoxes, std::numeric_limits<double>::infinity());  // contacts push and never pull
  problem.row_kind.assign(kBoxes, cleave::RowKind::normal);
  problem.friction_row.assign(kBoxes, -1);

  const std::vector<int> part_of_body(kBoxes, 0);  // one part
  cleave::Solution solution{problem.warm_impulse, {}};
  const cleave::SolveSummary summary =
      cleave::make_step_solver("exact")->solve(problem, part_of_body, solution);
  for (double impulse : solution.impulse) std::printf("%.4f N s\n", impulse);
  std::printf("%s, %s\n", to_string(summary.status),
              cleave::judge(problem, solution.impulse).exact ? "exact" : "not exact");
}
