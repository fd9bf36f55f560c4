#include "harness/experiment/chosen_kernel.h"

#include <algorithm>
#include <string_view>

#include "harness/base/names.h"
#include "partition/cost_features.h"
#include "solver/registry.h"

namespace cleave {
namespace {

// Of the kernels that can be chosen all have the same parameters, but for the arity of a tree, which
// partitioner auto has made.
std::vector<Parameter> kernel_parameters() {
  return find_row(kernel_table(), cost_kernel_names().front())->parameters;
}

std::string pair_name(const std::string& strategy, std::string_view kernel) {
  return strategy + ":" + std::string(kernel);
}

// The strategy of such a name; empty for any other.
std::string strategy_of(const std::string& solver) {
  const std::vector<std::string> names = chosen_kernel_solvers();
  return std::ranges::count(names, solver) > 0 ? solver_halves(solver).strategy : std::string();
}

class ChosenKernelSolver final : public StepSolver {
 public:
  ChosenKernelSolver(const Algorithm& named, const SolveOptions& options)
      : strategy_(strategy_of(named.name)), settings_(named.settings), options_(options) {}

  bool uses_partition() const override { return true; }

 private:
  // The solver of the kernel says it.
  std::string refuse_set(const StepProblem&) override { return ""; }

  SolveSummary do_solve(const StepProblem& problem, const Parts& parts, Solution& solution) override {
    if (std::ranges::count(cost_kernel_names(), parts.kernel) == 0) return refused(parts);
    if (solver_ == nullptr || parts.kernel != kernel_) {
      const std::string name = pair_name(strategy_, parts.kernel);
      solver_ = make_step_solver(Algorithm{name, name, settings_}, options_);
      kernel_ = parts.kernel;
    }
    return solver_->solve(problem, parts, solution);
  }

  static SolveSummary refused(const Parts& parts) {
    const std::vector<std::string> kernels(cost_kernel_names().begin(), cost_kernel_names().end());
    SolveSummary summary;
    summary.status = SolveStatus::refused;
    summary.message = "kernel chosen: parts are for " +
                      (parts.kernel.empty() ? "no kernel" : "kernel '" + std::string(parts.kernel) + "'") +
                      ", allowed: " + joined(kernels, ", ") + ", of which partitioner auto chooses";
    return summary;
  }

  std::string strategy_;
  Settings settings_;
  SolveOptions options_;
  std::unique_ptr<StepSolver> solver_;  // of the kernel at hand
  std::string kernel_;
};

}  // namespace

AlgorithmEntry chosen_kernel() {
  return {kChosenKernel, "that for which partitioner auto chose the parts",
          "harness/experiment/chosen_kernel.h", kernel_parameters()};
}

std::vector<std::string> chosen_kernel_solvers() {
  std::vector<std::string> names;
  for (const StrategyRow& strategy : strategy_table())
    if (strategy.traits.only_kernel == nullptr) names.push_back(pair_name(strategy.name, kChosenKernel));
  return names;
}

std::vector<Parameter> chosen_kernel_parameters(const std::string& solver) {
  const std::string strategy = strategy_of(solver);
  if (strategy.empty()) return {};
  return solver_parameters(pair_name(strategy, cost_kernel_names().front()));
}

std::unique_ptr<StepSolver> make_chosen_kernel_solver(const Algorithm& solver, const SolveOptions& options) {
  if (strategy_of(solver.name).empty()) return nullptr;
  return std::make_unique<ChosenKernelSolver>(solver, options);
}

}  // namespace cleave
