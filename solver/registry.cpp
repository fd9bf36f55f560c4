#include "solver/registry.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "harness/base/names.h"
#include "solver/baselines/baselines.h"
#include "solver/direct_solver.h"
#include "solver/kernels/kernel.h"
#include "solver/parameters.h"
#include "solver/strategies/strategy.h"

namespace cleave {
namespace {

using namespace parameters;
using Kind = Parameter::Kind;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void append_new(const std::vector<Parameter>& more, std::vector<Parameter>& to) {
  for (const Parameter& parameter : more)
    if (std::ranges::count(to, parameter.name, &Parameter::name) == 0) to.push_back(parameter);
}

// Who of all rows has a parameter.
std::string owners(const std::string& parameter) {
  std::vector<std::string> names;
  for (const StrategyRow& row : strategy_table())
    if (has_parameter(row, parameter)) names.push_back(std::string("strategy ") + row.name);
  for (const KernelRow& row : kernel_table())
    if (has_parameter(row, parameter)) names.push_back(std::string("kernel ") + row.name);
  for (const SolverRow& row : solver_table())
    if (has_parameter(row, parameter)) names.push_back(row.name);
  return joined(names);
}

std::vector<SolverRow>& added_solvers() {
  static std::vector<SolverRow> rows;
  return rows;
}

std::vector<SolverRow> with_added(std::span<const SolverRow> rows) {
  std::vector<SolverRow> all(rows.begin(), rows.end());
  std::ranges::copy(added_solvers(), std::back_inserter(all));
  return all;
}

}  // namespace

std::span<const StrategyRow> strategy_table() {
  static const StrategyRow table[] = {
      {{"pivot",
        "block principal pivoting, hands over to interior-point when stuck",
        "Judice and Pires 1994; Murty 1974",
        {max_iterations(), predictor_sweeps()}},
       make_pivot,
       {.always_exact = true}},
      {{"newton",
        "semi-smooth Newton with exact line search",
        "Qi and Sun 1993; Todorov 2014",
        {max_iterations()}},
       make_newton},
      {{"interior-point",
        "Mehrotra predictor-corrector with an exact last solve",
        "Mehrotra 1992",
        {max_iterations()}},
       make_interior_point,
       {.always_exact = true}},
      {{"alternate",
        "parts and interface in turn, as published; may not converge",
        "Peiret et al. 2019, section 5",
        {max_iterations()}},
       make_alternate,
       {.only_kernel = "schur-rows"}},
      {{"auto",
        "chosen per step from row kinds, sets, compliance and the impulses at hand",
        "solver/strategies/automatic.h",
        {max_iterations(), predictor_sweeps()}},
       nullptr,
       {.always_exact = true}},
  };
  return table;
}

std::span<const KernelRow> kernel_table() {
  static const KernelRow table[] = {
      {{"monolithic", "one sparse block Cholesky of M + J^T D J", "Duff and Reid 1983", {reuse_analysis()}},
       make_monolithic_kernel},
      {{"schur-rows",
        "parts in parallel, dense interface over the cut rows",
        "Peiret et al. 2019; Liu and Andrews 2022",
        {reuse_analysis()}},
       make_schur_rows_kernel,
       {.splits = true}},
      {{"schur-bodies",
        "interiors in parallel, interface on a vertex cover of the cut",
        "solver/kernels/schur_bodies.cpp",
        {reuse_analysis()}},
       make_schur_bodies_kernel,
       {.splits = true}},
      {{"schur-nested",
        "parts in a tree, interfaces of bodies at every level",
        "George 1973; Karypis and Kumar 1998",
        {reuse_analysis(),
         {.name = "arity",
          .kind = Kind::integer,
          .default_value = "2",
          .range = {2, 64},
          .help =
              "parts that a set of bodies is split into, again and again until each has at most max-bodies",
          .source = "Karypis and Kumar 1998"}}},
       make_schur_nested_kernel,
       {.splits = true}},
      {{"dense", "one dense matrix, the oracle of the tests", "-", {reuse_analysis()}}, make_dense_kernel},
      {{"auto", "the whole system: monolithic", "solver/kernels/monolithic.cpp", {reuse_analysis()}},
       make_monolithic_kernel,
       {.runs_as = "monolithic"}},
  };
  return table;
}

std::span<const SolverRow> solver_table() {
  static const SolverRow table[] = {
      {{"dense", "pivot:dense, the oracle", "-"}, nullptr, {"pivot", "dense"}},
      {{"monolithic", "pivot:monolithic", "-"}, nullptr, {"pivot", "monolithic"}},
      {{"schur", "pivot:schur-rows, the paper's parallel solver", "Liu and Andrews 2022, section 2"},
       nullptr,
       {"pivot", "schur-rows"}},
      {{"exact", "auto:auto", "-"}, nullptr, {"auto", "auto"}},
      {{"pgs",
        "projected Gauss-Seidel, constraint by constraint, in several orders",
        "Catto 2005; Poulsen, Niebe and Erleben 2010",
        {sweeps(),
         until(),
         order(),
         {.name = "order-seed",
          .kind = Kind::integer,
          .default_value = "1",
          .range = {0, kInfinity},
          .help = "seed of the dice of order=random"}}},
       make_pgs},
      {{"pgs-colored",
        "projected Gauss-Seidel, groups of rows of one colour in parallel",
        "Fratarcangeli, Tibaldo, Pellacini 2016",
        {sweeps(),
         until(),
         {.name = "coloring",
          .kind = Kind::word,
          .default_value = "greedy",
          .words = {"greedy", "vivace"},
          .help = "how pgs-colored finds colours: one group after another, or by chance",
          .source = "solver/group_coloring.h"},
         {.name = "coloring-seed",
          .kind = Kind::integer,
          .default_value = "1",
          .range = {0, kInfinity},
          .help = "seed of the dice of coloring=vivace"}}},
       make_pgs_colored},
      {{"pgs-parts",
        "projected Gauss-Seidel within parts in parallel, then over the cut",
        "solver/baselines/pgs_parts.cpp",
        {sweeps(), until()}},
       make_pgs_parts},
      {{"apgd",
        "accelerated projected gradient with restart, best iterate",
        "Mazhar, Heyn, Negrut and Tasora 2015; O'Donoghue and Candes 2015",
        {sweeps(), until()}},
       make_apgd},
      {{"jacobi-split",
        "mass splitting: parallel Jacobi over pairs of bodies",
        "Tonge, Benevolenski and Voroshilov 2012",
        {sweeps(), until()}},
       make_jacobi_split},
      {{"split-domains",
        "parts sweep in parallel on copies of bodies that are averaged",
        "Iglberger and Ruede 2011; Tonge et al. 2012",
        {sweeps(), until()}},
       make_split_domains},
      {{"lemke",
        "Lemke's complementary pivots, lexicographic, dense",
        "Lemke 1965; Cottle, Pang and Stone 1992, section 4.4",
        {{.name = "lemke-max-rows",
          .kind = Kind::integer,
          .default_value = "500",
          .range = {0, kInfinity},
          .help = "rows above which lemke refuses a step: its time grows with their cube",
          .source = "solver/baselines/lemke.cpp"}}},
       make_lemke},
  };
  static const std::vector<SolverRow> all = with_added(table);
  return all;
}

void add_solvers(std::span<const SolverRow> rows) {
  std::ranges::copy(rows, std::back_inserter(added_solvers()));
}

bool runs_on(const StrategyRow& strategy, const KernelRow& kernel) {
  return strategy.traits.only_kernel == nullptr ||
         std::string_view(strategy.traits.only_kernel) == kernel.name;
}

std::vector<std::string> all_solver_names() {
  std::vector<std::string> names = names_of(solver_table());
  for (const StrategyRow& strategy : strategy_table()) {
    for (const KernelRow& kernel : kernel_table()) {
      if (!runs_on(strategy, kernel)) continue;
      names.push_back(std::string(strategy.name) + ":" + kernel.name);
    }
  }
  return names;
}

SolverHalves solver_halves(const std::string& name) {
  const std::size_t colon = name.find(':');
  if (colon != std::string::npos) return {name.substr(0, colon), name.substr(colon + 1)};
  const SolverRow* row = find_row(solver_table(), name);
  return row != nullptr && row->alias.strategy != nullptr
             ? SolverHalves{row->alias.strategy, row->alias.kernel}
             : SolverHalves{};
}

std::vector<Parameter> solver_parameters(const std::string& name) {
  std::vector<Parameter> parameters;
  if (const SolverRow* row = find_row(solver_table(), name)) parameters = row->parameters;
  const SolverHalves halves = solver_halves(name);
  if (const StrategyRow* row = find_row(strategy_table(), halves.strategy))
    append_new(row->parameters, parameters);
  if (const KernelRow* row = find_row(kernel_table(), halves.kernel)) append_new(row->parameters, parameters);
  return parameters;
}

std::unique_ptr<StepSolver> make_step_solver(const Algorithm& algorithm, const SolveOptions& options) {
  const SolverRow* row = find_row(solver_table(), algorithm.name);
  if (row != nullptr) check_available("solver", *row);
  if (row != nullptr && row->make != nullptr) return row->make(options, algorithm.settings);
  const SolverHalves halves = solver_halves(algorithm.name);
  std::unique_ptr<StepSolver> solver =
      make_direct_solver(halves.strategy, halves.kernel, options, algorithm.settings);
  if (solver == nullptr)
    throw std::invalid_argument("solver: " + unknown_name_text(algorithm.name, all_solver_names()));
  return solver;
}

std::unique_ptr<StepSolver> make_step_solver(const std::string& text, const SolveOptions& options) {
  const std::string name = algorithm_name(text);
  check_name("solver", name, all_solver_names());
  return make_step_solver(read_algorithm("solver", text, solver_parameters(name), {}, owners), options);
}

}  // namespace cleave
