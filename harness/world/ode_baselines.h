// ODE's own solvers as baselines: `ode-step` (dWorldStep) and `ode-quickstep` (dWorldQuickStep).
//
// They are ordinary solvers of --solver, but a StepProblem alone does not make an ODE world: they also need
// the world and the contacts that the problem was extracted from. For every solve the world is rebuilt with
// the step's ERP and CFM, each contact becomes a contact joint, and ODE solves
//
//     (J M^-1 J^T + C) lambda_f = (b - J v0) / h,   lambda_f = lambda / h within its bounds:
//
// row by row. Friction bounds are, by --ode-friction:
//
//   limits   the problem's, as constant force limits (dContactMu2 without dContactApprox1: mu = hi_t1 / h,
//            mu2 = hi_t2 / h): the very same MLCP
//   pyramid  ODE's own (dContactApprox1): mu times the normal force that dWorldStep finds without friction,
//            and of the moment in dWorldQuickStep. dWorldStep then takes up all normal rows before any
//            friction row. The same MLCP as long as no friction row is at its bound.
//
// The forces f that joint feedback returns are turned back into impulses, the
// lambda with J_c^T lambda = h f over the rows of each constraint c. What ODE makes of it is judged as any
// other solver's result. t_s is the time of dWorldStep or dWorldQuickStep, which contains ODE's own rows and
// its integration, not the rebuilding.
//
// dWorldStep solves exactly (Dantzig's method as in Baraff, SIGGRAPH 1994) unless it meets a pivot <= 0: then
// it gives the message "LCP internal error, s <= 0" and leaves the unknowns that are left at zero. Its time
// grows with the fourth to fifth power of the rows. dWorldQuickStep is projected Gauss-Seidel with
// over-relaxation and random row order, a fixed number of iterations from zero; the warm start is not used.
// ODE's random generator is seeded before each.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "harness/base/algorithm.h"
#include "harness/world/step_context.h"
#include "solver/step_solver.h"

namespace cleave {

// ode-friction: see above.
enum class OdeFriction { limits, pyramid };

std::span<const AlgorithmEntry> ode_baselines();

// nullptr for a name that is none of ode_baselines(). context: what the next problems are extracted from;
// must outlive the solver, and world and contacts the solves. The problem's friction bounds may change from
// solve to solve, nothing else. Without a world a problem is refused.
std::unique_ptr<StepSolver> make_ode_baseline(const Algorithm& algorithm, const StepContext& context);

// The parameter ode-friction of such an algorithm.
OdeFriction ode_friction(const Settings& settings);

}  // namespace cleave
