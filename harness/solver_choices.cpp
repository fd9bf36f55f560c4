#include "harness/solver_choices.h"

#include <algorithm>
#include <iterator>

#include "harness/nearest_name.h"
#include "harness/ode_baselines.h"

namespace cleave {
namespace {

SolveOptions solve_options(const RunOptions& options) {
  SolveOptions solve;
  solve.threads = options.threads;
  solve.sweeps = options.sweeps;
  solve.predictor_sweeps = options.predictor_sweeps;
  solve.max_iterations = options.max_iterations;
  solve.reuse_analysis = options.reuse_analysis;
  return solve;
}

}  // namespace

std::vector<SolverEntry> solver_entries() {
  std::vector<SolverEntry> entries;
  for (const SolverRow& row : solver_table()) entries.push_back(row.entry);
  std::ranges::copy(ode_baselines(), std::back_inserter(entries));
  return entries;
}

std::vector<std::string> solver_choices() {
  std::vector<std::string> names = all_solver_names();
  std::ranges::move(names_of(ode_baselines()), std::back_inserter(names));
  return names;
}

std::unique_ptr<StepSolver> make_solver(const std::string& name, const RunOptions& options) {
  if (std::unique_ptr<OdeBaseline> baseline = make_ode_baseline(name, options.ode_baseline)) return baseline;
  return make_step_solver(name, solve_options(options));
}

}  // namespace cleave
