// The tables of solvers, strategies and kernels that `cleave list`, the command line and the tests iterate.
// A new strategy, kernel or baseline is one new file and one row here (registry.cpp).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solver/kernels/kernel.h"
#include "solver/step_solver.h"
#include "solver/strategies/strategy.h"

namespace cleave {

struct SolverEntry {
  const char* name;
  const char* help;       // one line
  const char* reference;  // where it is described
};

struct StrategyRow {
  SolverEntry entry;
  const char* only_kernel;              // the one kernel it runs on; nullptr: any
  std::unique_ptr<Strategy> (*make)();  // nullptr: chosen per step (auto)
};

struct KernelRow {
  SolverEntry entry;
  bool splits;           // uses the partition
  const char* resolved;  // what runs under this name
  std::unique_ptr<Kernel> (*make)();
};

// Short names: either an alias of strategy:kernel, or a baseline of its own.
struct SolverRow {
  SolverEntry entry;
  const char* strategy;  // of an alias
  const char* kernel;
  std::unique_ptr<StepSolver> (*make)(const SolveOptions& options);  // of a baseline
};

std::span<const StrategyRow> strategy_table();
std::span<const KernelRow> kernel_table();
std::span<const SolverRow> solver_table();

// Whether strategy:kernel is a solver.
bool runs_on(const StrategyRow& strategy, const KernelRow& kernel);

// Every name make_step_solver accepts: the short names, then every allowed strategy:kernel.
std::vector<std::string> all_solver_names();

}  // namespace cleave
