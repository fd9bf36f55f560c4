// Kernel `chosen`: the one for which the parts were chosen.
//
// pivot:chosen, newton:chosen, interior-point:chosen and auto:chosen are named as any other strategy:kernel,
// but whoever splits the bodies says which kernel runs (Parts::kernel): partitioner auto, which models the
// time of one, or with cost-kernel `any` of every kernel of cost_kernel_names. Parts that were chosen for no
// kernel are refused.
//
// A solve is, to the byte, that of strategy:KERNEL on these parts. Where the kernel is another than in the
// solve before, nothing of that one is carried over, in a session neither.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/base/algorithm.h"
#include "solver/step_solver.h"

namespace cleave {

inline constexpr const char* kChosenKernel = "chosen";

// Its row among the kernels.
AlgorithmEntry chosen_kernel();

// Every strategy:chosen: of the strategies that run on any kernel.
std::vector<std::string> chosen_kernel_solvers();

// What such a solver lets its users choose. Empty for a name that is none of them.
std::vector<Parameter> chosen_kernel_parameters(const std::string& solver);

// nullptr for a name that is none of them.
std::unique_ptr<StepSolver> make_chosen_kernel_solver(const Algorithm& solver, const SolveOptions& options);

}  // namespace cleave
