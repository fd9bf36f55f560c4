#include "partition/cost_model.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

namespace cleave {
namespace {

double sum(const CostFeatures& features, double PartCost::*of_part) {
  double total = 0;
  for (const PartCost& part : features.parts) total += part.*of_part;
  return total;
}

// A part is a task of schur-rows, which waits for the last of them. Other kernels deal out branches of one
// elimination tree, whatever the parts.
double local_work(const CostFeatures& features, int threads, double PartCost::*work) {
  if (features.kernel != CostKernel::schur_rows || threads == 1) return sum(features, work) / threads;
  std::vector<double> tasks;
  for (const PartCost& part : features.parts) tasks.push_back(part.*work);
  return longest_first_makespan(std::move(tasks), threads);
}

using Group = CostGroup;

constexpr CostTerm kTerms[] = {
    {"us_per_solve", "to begin and end a solve", 1e-3, false, Group::sweeps_and_assembly,
     [](const CostFeatures&, int) { return 1.0; }},
    {"ns_per_row", "predicting, a row of the step", 1e-6, false, Group::sweeps_and_assembly,
     [](const CostFeatures& f, int) { return static_cast<double>(f.rows); }},
    {"ns_per_row_prepared", "preparing before the analysis, a row of the step", 1e-6, false, Group::analysis,
     [](const CostFeatures& f, int) { return static_cast<double>(f.rows); }},
    {"ns_per_block", "symbolic analysis, a block of a factor", 1e-6, false, Group::analysis,
     [](const CostFeatures& f, int) { return sum(f, &PartCost::blocks) + f.interface_blocks; }},
    {"us_per_part", "dealing out, a part and pass", 1e-3, true, Group::sweeps_and_assembly,
     [](const CostFeatures& f, int) { return static_cast<double>(f.parts.size()); }},
    {"ns_per_row_and_pass", "assembling and checking, a row and pass", 1e-6, true, Group::sweeps_and_assembly,
     [](const CostFeatures& f, int) { return static_cast<double>(f.rows); }},
    {"ns_per_local_block", "factoring the parts, a block", 1e-6, true, Group::local,
     [](const CostFeatures& f, int threads) { return local_work(f, threads, &PartCost::blocks); }},
    {"ns_per_local_flop", "factoring the parts", 1e-6, true, Group::local,
     [](const CostFeatures& f, int threads) { return local_work(f, threads, &PartCost::factor_flops); }},
    {"ns_per_forming_flop", "forming a dense interface", 1e-6, true, Group::forming,
     [](const CostFeatures& f, int threads) { return local_work(f, threads, &PartCost::form_flops); }},
    {"ns_per_interface_flop", "factoring the interface", 1e-6, true, Group::interface,
     [](const CostFeatures& f, int) { return f.interface_flops; }},
    {"ns_per_entry", "substituting, an entry of a factor and pass", 1e-6, true, Group::substitution,
     [](const CostFeatures& f, int) { return sum(f, &PartCost::entries) + f.interface_entries; }},
    {"ns_per_body", "predicting, a body", 1e-6, false, Group::sweeps_and_assembly,
     [](const CostFeatures& f, int) { return static_cast<double>(f.bodies); }},
};

}  // namespace

std::span<const CostTerm, kCostTerms> cost_terms() { return kTerms; }

std::array<double, kCostTerms> unit_costs_ms(const CostFeatures& features, int threads,
                                             double factorizations) {
  std::array<double, kCostTerms> costs;
  for (int t = 0; t < kCostTerms; ++t)
    costs[t] =
        kTerms[t].unit_ms * kTerms[t].count(features, threads) * (kTerms[t].of_a_pass ? factorizations : 1.0);
  return costs;
}

std::array<double, 5> ExpectedFactorizations::terms(const CostFeatures& features) {
  const double bodies = std::max(features.bodies, 1);
  return {1, std::log(bodies), features.edges / bodies, features.mass_spread, features.fixed_rows / bodies};
}

double ExpectedFactorizations::of(const CostFeatures& features) const {
  const auto [one, log_bodies, degree, spread, fixed_rows] = terms(features);
  return std::clamp(std::exp(constant * one + per_log_body * log_bodies + per_degree * degree +
                             per_mass_spread * spread + per_fixed_row * fixed_rows),
                    1.0, most);
}

ExpectedFactorizations ExpectedFactorizations::always(double factorizations) {
  return {.constant = std::log(factorizations), .most = factorizations};
}

// A graph without edges has no cut, and no share of it.
std::array<double, 3> ExpectedActiveShare::terms(const BodyGraph& graph) {
  if (graph.edge_count() == 0) return {1, 0, 0};
  const double edges = graph.edge_count();
  double sides = 0;  // of constraints
  for (int i = 0; i < graph.body_count(); ++i)
    for (int k = graph.first(i); k < graph.last(i); ++k) sides += graph.weight(k, EdgeWeight::constraints);
  return {1, std::log(edges / graph.body_count()), sides / (2 * edges)};
}

double ExpectedActiveShare::of(const BodyGraph& graph) const {
  const auto [one, log_degree, constraints] = terms(graph);
  return std::clamp(
      1 - std::exp(-constant * one - per_log_degree * log_degree - per_constraint * constraints), 0.0, 1.0);
}

ExpectedActiveShare ExpectedActiveShare::always(double share) { return {-std::log(1 - share), 0, 0}; }

CostCounter cost_counter(const BodyGraph& graph, const KernelCost& cost) {
  return {graph, cost.kernel, cost.active_share.of(graph)};
}

double modelled_ms(const CostFeatures& features, const KernelCost& cost) {
  const std::array<double, kCostTerms> units =
      unit_costs_ms(features, cost.threads, cost.factorizations.of(features));
  return std::inner_product(units.begin(), units.end(), cost.cost.begin(), 0.0);
}

double longest_first_makespan(std::vector<double> work, int workers) {
  std::sort(work.begin(), work.end(), std::greater<>());
  std::vector<double> free_at(workers, 0.0);  // a heap, the earliest first
  for (const double task : work) {
    std::pop_heap(free_at.begin(), free_at.end(), std::greater<>());
    free_at.back() += task;
    std::push_heap(free_at.begin(), free_at.end(), std::greater<>());
  }
  return *std::max_element(free_at.begin(), free_at.end());
}

}  // namespace cleave
