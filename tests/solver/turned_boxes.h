// Problems whose friction boxes are turned in their tangent planes, and the same problems in scalar rows.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "solver/solution.h"
#include "solver/step_problem.h"
#include "solver/step_solver.h"
#include "tests/solver/seeded_random.h"

namespace cleave {

// Normal rows that their two friction rows follow.
std::vector<int> contacts_of(const StepProblem& problem);

// The problem with the boxes of most of its contacts turned by angles from the seed, and with tangents that
// are to move (b is not zero).
StepProblem turn_boxes(StepProblem problem, std::uint64_t seed);

// A pile of such contacts.
StepProblem make_turned_pile(std::uint64_t seed, double cfm);

// The same problem with intervals only: tangent rows (J, b) combined along the axes of their box.
StepProblem in_turned_rows(const StepProblem& problem);

// (m) Impulses of one problem as those of the other.
std::vector<double> along_axes(const StepProblem& problem, std::span<const double> in_rows);
std::vector<double> along_rows(const StepProblem& problem, std::span<const double> in_axes);

struct Answer {
  Solution solution;
  SolveSummary summary;
};

// Of a new solver, from zero impulses.
Answer solve(const std::string& solver, const StepProblem& problem, const std::vector<int>& parts);

double largest_difference(std::span<const double> a, std::span<const double> b);

}  // namespace cleave
