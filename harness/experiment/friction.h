// Friction models: what the friction rows of a contact may carry.
//
//   none           friction rows are not built
//   constant       bound = h * friction force, as ODE's contacts take mu without dContactApprox1
//   box            bound = mu * predicted normal impulse, then frozen: a true MLCP, the same for every solver
//   box-converged  bounds iterated until they match the normal impulses of the solution
//   cone           |lambda_t| <= mu lambda_n for the two together, a convex problem: what slides lifts off
//   coulomb        Coulomb's law
//
// The bound of a box is the same on both tangents, so a box is up to sqrt(2) too strong between them.
// extract() builds the rows; each model's file sets what rows with friction_coefficient > 0 may carry and
// leaves all others alone.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/base/algorithm.h"
#include "harness/world/extract.h"
#include "solver/step_problem.h"

namespace cleave {

struct FrictionModelEntry : AlgorithmEntry {
  FrictionModel model;
  ContactSet contact_set = ContactSet::box;  // of the contacts whose friction rows have a coefficient
  // What extraction leaves to be set on every step; null: nothing.
  void (*set)(const ExtractOptions& options, StepProblem& problem) = nullptr;
  bool of_recorded = false;  // `replay --friction` can give it to the contacts of any problem file
};

std::span<const FrictionModelEntry> friction_models();

// Of a name in the table; throws std::logic_error for another.
const FrictionModelEntry& friction_model(const std::string& name);
const FrictionModelEntry& friction_model(FrictionModel model);

// The names that `replay --friction` takes.
std::vector<std::string> recorded_friction_models();

// Whether what a friction row may carry is a box whose bound stands for mu times its contact's normal
// impulse.
inline bool has_frozen_bound(const StepProblem& problem, int row) {
  if (!(problem.friction_coefficient[row] > 0)) return false;
  return problem.contact_set.empty() || problem.contact_set[problem.friction_row[row]] == ContactSet::box;
}

}  // namespace cleave
