#include "harness/experiment/cost_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "harness/base/nonnegative_least_squares.h"

namespace cleave {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

CostFeatures features_of(const CostSample& sample, double active_share) {
  return CostCounter(sample.graph, sample.kernel, active_share)
      .count(sample.parts.part_of_body, sample.parts.part_count);
}

// Where samples do not tell the terms apart, the least of all coefficients that fit them.
ExpectedFactorizations fit_factorizations(std::span<const CostSample> samples,
                                          std::span<const std::array<double, 3>> terms_of_sample) {
  Eigen::MatrixXd terms(samples.size(), 3);
  Eigen::VectorXd logarithm(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    terms.row(k) = Eigen::Map<const Eigen::RowVector3d>(terms_of_sample[k].data());
    logarithm[k] = std::log(samples[k].factorizations);
  }
  const Eigen::Vector3d fitted = terms.completeOrthogonalDecomposition().solve(logarithm);
  return {fitted[0], fitted[1], fitted[2], std::max(1.0, std::exp((terms * fitted).maxCoeff()))};
}

void fit_group(std::span<const CostSample> samples, std::span<const std::array<double, kCostTerms>> units,
               int group, KernelCost& cost) {
  std::vector<int> terms;
  for (int t = 0; t < kCostTerms; ++t)
    if (static_cast<int>(cost_terms()[t].group) == group) terms.push_back(t);
  std::vector<double> a, b;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    for (const int t : terms) a.push_back(units[k][t] / samples[k].t_s_ms);
    b.push_back(samples[k].group_ms[group] / samples[k].t_s_ms);
  }
  const std::vector<double> fitted = nonnegative_least_squares(a, b, static_cast<int>(terms.size()));
  for (std::size_t i = 0; i < terms.size(); ++i) cost.cost[terms[i]] = fitted[i];
}

}  // namespace

// n (n + 1) (2 n + 1) / 6 = (n + 1/2)^3 / 3 - (n + 1/2) / 12, of which the second term is lost in the first.
double interface_size(double flops) {
  if (flops <= 0) return 0;
  double n = std::cbrt(3 * flops) - 0.5;
  for (int i = 0; i < 3; ++i) {
    const double value = n * (n + 1) * (2 * n + 1) / 6 - flops, slope = n * n + n + 1.0 / 6;
    n -= value / slope;
  }
  return n;
}

KernelCost fit_cost(std::span<const CostSample> samples) {
  KernelCost cost{samples.front().kernel, samples.front().threads, {}, 1, {}};
  std::vector<double> shares;
  std::vector<std::array<double, 3>> terms;  // of the factorisations
  std::vector<std::array<double, kCostTerms>> units;
  for (const CostSample& sample : samples) {
    const CostFeatures features = features_of(sample, sample.active_share);
    if (features.cut_rows > 0) shares.push_back(sample.active_share);
    units.push_back(unit_costs_ms(features, sample.threads, sample.factorizations));
    terms.push_back(ExpectedFactorizations::terms(features));
  }
  cost.factorizations = fit_factorizations(samples, terms);
  if (!shares.empty()) cost.active_share = median(std::move(shares));
  for (int group = 0; group < kCostGroups; ++group) fit_group(samples, units, group, cost);
  return cost;
}

double modelled_ms(const CostSample& sample, const KernelCost& cost, bool counted) {
  KernelCost own = cost;
  if (counted) {
    own.factorizations = ExpectedFactorizations::always(sample.factorizations);
    own.active_share = sample.active_share;
  }
  return modelled_ms(features_of(sample, own.active_share), own);
}

double median_error(std::span<const CostSample> samples, const KernelCost& cost, bool counted) {
  std::vector<double> errors;
  for (const CostSample& sample : samples)
    errors.push_back(std::abs(modelled_ms(sample, cost, counted) / sample.t_s_ms - 1));
  return median(std::move(errors));
}

double median_cell_error(std::span<const CostSample> samples, const KernelCost& cost) {
  struct Sums {
    double modelled_ms = 0, measured_ms = 0;
  };
  std::map<int, Sums> cells;
  for (const CostSample& sample : samples) {
    Sums& sums = cells[sample.cell];
    sums.modelled_ms += modelled_ms(sample, cost, false);
    sums.measured_ms += sample.t_s_ms;
  }
  std::vector<double> errors;
  for (const auto& [cell, sums] : cells) errors.push_back(std::abs(sums.modelled_ms / sums.measured_ms - 1));
  return median(std::move(errors));
}

}  // namespace cleave
