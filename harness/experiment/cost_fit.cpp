#include "harness/experiment/cost_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
  KernelCost cost{samples.front().kernel, samples.front().threads, 1, 1, {}};
  std::vector<double> factorizations, shares, a, b;
  for (const CostSample& sample : samples) {
    factorizations.push_back(sample.factorizations);
    const CostFeatures features = features_of(sample, sample.active_share);
    if (features.cut_rows > 0) shares.push_back(sample.active_share);
    for (const double unit : unit_costs_ms(features, sample.threads, sample.factorizations))
      a.push_back(unit / sample.t_s_ms);
    b.push_back(1);
  }
  cost.factorizations = median(std::move(factorizations));
  if (!shares.empty()) cost.active_share = median(std::move(shares));
  std::ranges::copy(nonnegative_least_squares(a, b, kCostTerms), cost.cost.begin());
  return cost;
}

double modelled_ms(const CostSample& sample, const KernelCost& cost, bool counted) {
  KernelCost own = cost;
  if (counted) {
    own.factorizations = sample.factorizations;
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

}  // namespace cleave
