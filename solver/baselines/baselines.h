// Solvers that are not a strategy on a kernel. One file each in this folder, declared here, one row each in
// registry.cpp.
#pragma once

#include <memory>

#include "harness/base/parameter.h"
#include "solver/step_solver.h"

namespace cleave {

std::unique_ptr<StepSolver> make_pgs(const SolveOptions& options, const Settings& settings);
std::unique_ptr<StepSolver> make_pgs_parts(const SolveOptions& options, const Settings& settings);
std::unique_ptr<StepSolver> make_apgd(const SolveOptions& options, const Settings& settings);
std::unique_ptr<StepSolver> make_jacobi_split(const SolveOptions& options, const Settings& settings);
std::unique_ptr<StepSolver> make_split_domains(const SolveOptions& options, const Settings& settings);
std::unique_ptr<StepSolver> make_lemke(const SolveOptions& options, const Settings& settings);
std::unique_ptr<StepSolver> make_pgs_colored(const SolveOptions& options, const Settings& settings);

}  // namespace cleave
