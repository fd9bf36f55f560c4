// Friction models: how the bounds of the friction rows are set.
//
//   none           friction rows are not built
//   constant       bound = h * friction force, as ODE's contacts take mu without dContactApprox1
//   box            bound = mu * predicted normal impulse, then frozen: a true MLCP, the same for every solver
//   box-converged  bounds iterated until they match the normal impulses of the solution
//
// A bound is the same on both tangents, so the box is up to sqrt(2) too strong between them. extract() builds
// the rows; the functions below set the bounds of rows with friction_coefficient > 0 and leave all others
// alone.
#pragma once

#include <span>

#include "harness/base/algorithm.h"
#include "harness/world/extract.h"
#include "solver/solution.h"
#include "solver/step_problem.h"
#include "solver/step_solver.h"

namespace cleave {

struct FrictionModelEntry : AlgorithmEntry {
  FrictionModel model;
};

std::span<const FrictionModelEntry> friction_models();

// Of a name in the table; throws std::logic_error for another.
FrictionModel friction_model(const std::string& name);

inline constexpr int kPredictionSweeps = 5;
inline constexpr int kBoundIterationCap = 50;
inline constexpr double kBoundTolerance = 1e-6;
inline constexpr double kBoundFloor = 1e-6;

// `box`: starts from warm_impulse, runs kPredictionSweeps projected Gauss-Seidel sweeps in row order, in
// which a friction row is clamped to +-mu times the present impulse of its normal row, and freezes the bounds
// at +-mu times the resulting normal impulses. The impulses themselves are thrown away. O(rows) time.
void predict_friction_bounds(StepProblem& problem);

// How far frozen bounds are from Coulomb's: the largest |bound - mu lambda_n| over the friction rows with
// friction_coefficient > 0, relative to max(mu lambda_n, kBoundFloor * the largest mu lambda_n of the step,
// 1e-12 N s): contacts that carry next to nothing do not count relative to themselves. lambda_n below zero
// counts as zero; 0 where no bound follows a normal impulse. impulse: (m).
double bound_mismatch(const StepProblem& problem, std::span<const double> impulse);

struct ConvergedBounds {
  int solves = 0;             // >= 1
  double mismatch = 0;        // bound_mismatch of the solution
  bool converged = false;     // mismatch <= kBoundTolerance
  SolveSummary last_summary;  // of the last solve; its status is not ok when the solver failed
};

// `box-converged`: solves with the present bounds (those of predict_friction_bounds to begin with), sets them
// to +-mu times the normal impulses found and solves again from there, until bound_mismatch <=
// kBoundTolerance, the solver fails or kBoundIterationCap solves are done. The fixed point need not exist or
// attract; `converged` and `mismatch` say what came out. `problem` is left with the bounds that `solution`
// was solved for, a true MLCP in either case.
ConvergedBounds converge_friction_bounds(StepProblem& problem, StepSolver& solver, const Parts& parts,
                                         Solution& solution);

}  // namespace cleave
