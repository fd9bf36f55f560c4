// The tables of solvers, strategies and kernels that `cleave list`, the command line and the tests iterate. A
// new strategy, kernel or baseline is one new file, its make_...() declared in strategy.h, kernel.h or
// baselines.h, and one row here (registry.cpp).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "harness/base/algorithm.h"
#include "solver/step_solver.h"

namespace cleave {

class Kernel;    // solver/kernels/kernel.h
class Strategy;  // solver/strategies/strategy.h

struct StrategyTraits {
  // Ends within the judge's limit on every problem of boxes or cones that it takes; Coulomb's law may be
  // beyond it. Others say not_converged, honestly.
  bool always_exact = false;
  const char* only_kernel = nullptr;  // the one kernel it runs on; nullptr: any
};

struct StrategyRow : AlgorithmEntry {
  std::unique_ptr<Strategy> (*make)(const Settings& settings);  // nullptr: chosen per step (auto)
  StrategyTraits traits = {};
};

struct KernelTraits {
  bool splits = false;            // uses the partition
  const char* runs_as = nullptr;  // the kernel that runs under this name; nullptr: itself
};

struct KernelRow : AlgorithmEntry {
  std::unique_ptr<Kernel> (*make)(const Settings& settings);
  KernelTraits traits = {};
};

// Short names: either an alias of strategy:kernel, or a baseline of its own, which may miss the judge's
// limit.
struct SolverAlias {
  const char* strategy = nullptr;
  const char* kernel = nullptr;
};

struct SolverRow : AlgorithmEntry {
  std::unique_ptr<StepSolver> (*make)(const SolveOptions& options,
                                      const Settings& settings);  // nullptr: an alias, or unavailable
  SolverAlias alias = {};
};

std::span<const StrategyRow> strategy_table();
std::span<const KernelRow> kernel_table();
std::span<const SolverRow> solver_table();

// Rows of the program at hand, after those of this folder: other people's solvers, which nobody else is to
// link. Before the tables are first asked for; a row whose library was not there has no `make` and says so
// (`unavailable`).
void add_solvers(std::span<const SolverRow> rows);

// Whether strategy:kernel is a solver.
bool runs_on(const StrategyRow& strategy, const KernelRow& kernel);

// Every name of a solver: the short names, then every allowed strategy:kernel.
std::vector<std::string> all_solver_names();

// The two halves of a name; both empty for a baseline and for a name that is none.
struct SolverHalves {
  std::string strategy, kernel;
};
SolverHalves solver_halves(const std::string& name);

// What a solver of this name lets its users choose: the parameters of its strategy and its kernel, or its
// own.
std::vector<Parameter> solver_parameters(const std::string& name);

// From a short name ("schur") or strategy:kernel ("interior-point:monolithic"), with parameters where wanted
// ("pgs@sweeps=100"). Throws std::invalid_argument with one line that names the text and what is allowed.
std::unique_ptr<StepSolver> make_step_solver(const std::string& text, const SolveOptions& options = {});

// The same from complete settings. Throws std::invalid_argument for a name that is none.
std::unique_ptr<StepSolver> make_step_solver(const Algorithm& algorithm, const SolveOptions& options);

}  // namespace cleave
