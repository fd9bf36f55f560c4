// Problems whose contacts have cones or follow Coulomb's law.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/step_problem.h"

namespace cleave {

// One body of 1 kg and one contact at its centre, whose rows are the axes z, x, y.
struct Block {
  std::array<double, 3> free_velocity{};  // along the rows
  std::array<double, 3> rhs{};
  std::array<double, 3> compliance{};
  double mu = 0.5;
  ContactSet set = ContactSet::cone;
  int tangents = 2;
};

StepProblem make_block(const Block& block);

// A block pressed on the plane that slides at an angle to the tangents, or sticks: answers on paper.
struct Paper {
  StepProblem problem;
  std::vector<double> impulse;
};

constexpr double kCompliance = 0.25, kPush = 0.5;  // the block would sink by kPush m/s

Paper make_paper(ContactSet set, double angle, double speed, double mu = 0.5, int tangents = 2);

// The problem with that set in the place of the boxes of the contacts chosen by the seed, about `share` of
// all.
StepProblem with_sets(StepProblem problem, ContactSet set, double share = 1, std::uint64_t seed = 1);

// A pile of such contacts, whose tangents are to move.
StepProblem make_cone_pile(std::uint64_t seed, double cfm, ContactSet set = ContactSet::cone);

}  // namespace cleave
