// What a solve takes, modelled from counted work: a sum of terms, each the product of a count
// (cost_features.h) and of what one of these costs on a machine, fitted by `cleave calibrate`.
//
//     t_s = terms of the solve + factorizations * terms of a pass
//
// A pass is a factorisation with its assembly, substitutions and checks. How often a strategy factors is not
// a matter of the partition, and not of the graph alone either; what can be expected of the graph is fitted
// too.
#pragma once

#include <array>
#include <span>

#include "partition/cost_features.h"

namespace cleave {

// What a solver's stages are told apart by, so that each is fitted to its own times.
enum class CostGroup { sweeps_and_assembly, analysis, local, forming, interface, substitution };
inline constexpr int kCostGroups = 6;

struct CostTerm {
  const char* name;  // of its coefficient, with the unit
  const char* help;
  double unit_ms;  // of the coefficient
  bool of_a_pass;
  CostGroup group;
  double (*count)(const CostFeatures& features, int threads);
};

inline constexpr int kCostTerms = 12;
std::span<const CostTerm, kCostTerms> cost_terms();

// Factorisations of a solve: more where there are more bodies and where their masses differ, fewer where a
// body is held by more others, as in a tower at rest. Within what was fitted,
//
//     ln factorizations = constant + per_log_body ln(bodies) + per_degree edges / bodies + per_mass_spread s
//                         + per_fixed_row rows with static geometry / bodies,   in [0, ln(most)]
//
// with s the standard deviation of ln(mass).
struct ExpectedFactorizations {
  double constant = 0, per_log_body = 0, per_degree = 0, per_mass_spread = 0, per_fixed_row = 0;
  double most = 1;

  // What the five numbers are coefficients of.
  static std::array<double, 5> terms(const CostFeatures& features);
  double of(const CostFeatures& features) const;
  static ExpectedFactorizations always(double factorizations);  // >= 1
};

// The share of cut rows whose weight is not zero, by which the interface of schur-rows is smaller than the
// cut: more of them in a graph whose bodies are held by more others, and by more contacts each, as few rows
// of what lies still slide or part. Within [0, 1],
//
//     -ln(1 - share) = constant + per_log_degree ln(edges / bodies)
//                    + per_constraint constraints between bodies / edges
struct ExpectedActiveShare {
  double constant = 0, per_log_degree = 0, per_constraint = 0;

  // What the three numbers are coefficients of.
  static std::array<double, 3> terms(const BodyGraph& graph);
  double of(const BodyGraph& graph) const;
  static ExpectedActiveShare always(double share);  // in [0, 1]
};

// One kernel on so many threads.
struct KernelCost {
  CostKernel kernel = CostKernel::schur_rows;
  int threads = 1;
  ExpectedFactorizations factorizations;
  ExpectedActiveShare active_share;
  std::array<double, kCostTerms> cost{};  // >= 0, in the units of the terms
};

// Each term's part of a solve in ms were its coefficient 1.
std::array<double, kCostTerms> unit_costs_ms(const CostFeatures& features, int threads,
                                             double factorizations);

// Counts for this kernel, with the active share that is expected of the graph.
CostCounter cost_counter(const BodyGraph& graph, const KernelCost& cost);

// Of a solve with the expected number of factorisations.
double modelled_ms(const CostFeatures& features, const KernelCost& cost);

// The end of the last of tasks that are dealt out longest first, each to the worker that is free first
// (Graham, SIAM Journal on Applied Mathematics 17, 1969). workers >= 1.
double longest_first_makespan(std::vector<double> work, int workers);

}  // namespace cleave
