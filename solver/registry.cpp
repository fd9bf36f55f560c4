#include "solver/registry.h"

#include "solver/baselines/baselines.h"

namespace cleave {
namespace {

constexpr StrategyRow kStrategies[] = {
    {{"pivot", "block principal pivoting, hands over to interior-point when stuck",
      "Judice and Pires 1994; Murty 1974"},
     nullptr,
     make_pivot},
    {{"newton", "semi-smooth Newton with exact line search", "Qi and Sun 1993; Todorov 2014"},
     nullptr,
     make_newton},
    {{"interior-point", "Mehrotra predictor-corrector with an exact last solve", "Mehrotra 1992"},
     nullptr,
     make_interior_point},
    {{"alternate", "parts and interface in turn, as published; may not converge",
      "Peiret et al. 2019, section 5"},
     "schur-rows",
     make_alternate},
    {{"auto", "chosen per step from row kinds and compliance", "solver/strategies/automatic.h"},
     nullptr,
     nullptr},
};

constexpr KernelRow kKernels[] = {
    {{"monolithic", "one sparse block Cholesky of M + J^T D J", "Duff and Reid 1983"},
     false,
     "monolithic",
     make_monolithic_kernel},
    {{"schur-rows", "parts in parallel, dense interface over the cut rows",
      "Peiret et al. 2019; Liu and Andrews 2022"},
     true,
     "schur-rows",
     make_schur_rows_kernel},
    {{"schur-bodies", "interiors in parallel, interface on a vertex cover of the cut",
      "solver/kernels/schur_bodies.cpp"},
     true,
     "schur-bodies",
     make_schur_bodies_kernel},
    {{"dense", "one dense matrix, the oracle of the tests", "-"}, false, "dense", make_dense_kernel},
    {{"auto", "chosen per step", "solver/strategies/automatic.h"},
     false,
     "monolithic",
     make_monolithic_kernel},
};

constexpr SolverRow kSolvers[] = {
    {{"dense", "pivot:dense, the oracle", "-"}, "pivot", "dense", nullptr},
    {{"monolithic", "pivot:monolithic", "-"}, "pivot", "monolithic", nullptr},
    {{"schur", "pivot:schur-rows, the paper's parallel solver", "Liu and Andrews 2022, section 2"},
     "pivot",
     "schur-rows",
     nullptr},
    {{"exact", "auto:auto", "-"}, "auto", "auto", nullptr},
    {{"pgs", "projected Gauss-Seidel, --sweeps sweeps in natural order", "Catto 2005"},
     nullptr,
     nullptr,
     make_pgs},
};

}  // namespace

std::span<const StrategyRow> strategy_table() { return kStrategies; }
std::span<const KernelRow> kernel_table() { return kKernels; }
std::span<const SolverRow> solver_table() { return kSolvers; }

bool runs_on(const StrategyRow& strategy, const KernelRow& kernel) {
  return strategy.only_kernel == nullptr || std::string_view(strategy.only_kernel) == kernel.entry.name;
}

std::vector<std::string> all_solver_names() {
  std::vector<std::string> names;
  for (const SolverRow& row : kSolvers) names.emplace_back(row.entry.name);
  for (const StrategyRow& strategy : kStrategies) {
    for (const KernelRow& kernel : kKernels) {
      if (!runs_on(strategy, kernel)) continue;
      names.push_back(std::string(strategy.entry.name) + ":" + kernel.entry.name);
    }
  }
  return names;
}

}  // namespace cleave
