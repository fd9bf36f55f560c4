#include "harness/experiment/cost_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "harness/base/median.h"
#include "harness/base/nonnegative_least_squares.h"

namespace cleave {
namespace {

CostFeatures features_of(const CostSample& sample, double active_share) {
  return CostCounter(sample.graph, sample.kernel, active_share).count(sample.parts);
}

// Row by row, as nonnegative_least_squares() takes it.
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

// The x of least |A x - b|, summed: a few steps that are like no others do not draw it to themselves, as they
// do where squares are summed. Squares are weighed by 1 / |A x - b| of the x before, again and again
// (Schlossmacher, Journal of the American Statistical Association 68, 1973). solve(A, b): the x of least
// squares.
template <class Solve>
Vector least_absolute_error(const Matrix& a, const Vector& b, const Solve& solve) {
  constexpr int kFits = 30;
  constexpr double kLeastError = 1e-3;
  Vector root = Vector::Ones(b.size()), x;  // of the weights
  for (int fit = 0; fit < kFits; ++fit) {
    x = solve(root.asDiagonal() * a, root.cwiseProduct(b));
    root = (a * x - b).cwiseAbs().cwiseMax(kLeastError).cwiseSqrt().cwiseInverse();
  }
  return x;
}

// Where samples do not tell the terms apart, the least of all coefficients that fit them.
Vector of_any_sign(const Matrix& a, const Vector& b) { return a.completeOrthogonalDecomposition().solve(b); }

Vector at_least_zero(const Matrix& a, const Vector& b) {
  const auto values = [](const auto& numbers) {
    return std::span(numbers.data(), static_cast<std::size_t>(numbers.size()));
  };
  const std::vector<double> x = nonnegative_least_squares(values(a), values(b), static_cast<int>(a.cols()));
  return Eigen::Map<const Vector>(x.data(), a.cols());
}

using FactorizationTerms = decltype(ExpectedFactorizations::terms({}));

ExpectedFactorizations fit_factorizations(std::span<const CostSample> samples,
                                          std::span<const FactorizationTerms> terms_of_sample) {
  Matrix terms(samples.size(), std::tuple_size_v<FactorizationTerms>);
  Vector logarithm(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    std::ranges::copy(terms_of_sample[k], terms.row(k).begin());
    logarithm[k] = std::log(samples[k].factorizations);
  }
  const Vector fitted = least_absolute_error(terms, logarithm, of_any_sign);
  return {fitted[0], fitted[1], fitted[2],
          fitted[3], fitted[4], std::max(1.0, std::exp((terms * fitted).maxCoeff()))};
}

// Of the samples with a cut. A cut whose rows are all active is like one in which few are not.
ExpectedActiveShare fit_active_share(std::span<const CostSample* const> samples) {
  constexpr double kFew = 0.02;
  if (samples.empty()) return {};
  Matrix terms(samples.size(), std::tuple_size_v<decltype(ExpectedActiveShare::terms({}))>);
  Vector logarithm(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    std::ranges::copy(ExpectedActiveShare::terms(samples[k]->graph), terms.row(k).begin());
    logarithm[k] = -std::log(std::max(1 - samples[k]->active_share, kFew));
  }
  const Vector fitted = least_absolute_error(terms, logarithm, of_any_sign);
  return {fitted[0], fitted[1], fitted[2]};
}

void fit_group(std::span<const CostSample> samples, std::span<const std::array<double, kCostTerms>> units,
               int group, KernelCost& cost) {
  std::vector<int> terms;
  for (int t = 0; t < kCostTerms; ++t)
    if (static_cast<int>(cost_terms()[t].group) == group) terms.push_back(t);
  Matrix a(samples.size(), terms.size());
  Vector b(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    for (std::size_t i = 0; i < terms.size(); ++i) a(k, i) = units[k][terms[i]] / samples[k].t_s_ms;
    b[k] = samples[k].group_ms[group] / samples[k].t_s_ms;
  }
  const Vector fitted = least_absolute_error(a, b, at_least_zero);
  for (std::size_t i = 0; i < terms.size(); ++i) cost.cost[terms[i]] = fitted[i];
}

// Half of the solves take more than modelled and half of them less: what is so of the stages is not of their
// sum.
void scale_to_whole(std::span<const CostSample> samples,
                    std::span<const std::array<double, kCostTerms>> units, KernelCost& cost) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double modelled = std::inner_product(units[k].begin(), units[k].end(), cost.cost.begin(), 0.0);
    if (modelled > 0) ratios.push_back(samples[k].t_s_ms / modelled);
  }
  if (ratios.empty()) return;
  const double scale = lower_median(std::move(ratios));
  for (double& coefficient : cost.cost) coefficient *= scale;
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
  KernelCost cost{samples.front().kernel, samples.front().threads, {}, {}, {}};
  std::vector<const CostSample*> cut;
  std::vector<FactorizationTerms> terms;  // of the factorisations
  std::vector<std::array<double, kCostTerms>> units;
  for (const CostSample& sample : samples) {
    const CostFeatures features = features_of(sample, sample.active_share);
    if (cost.kernel == CostKernel::schur_rows && features.cut_rows > 0) cut.push_back(&sample);
    units.push_back(unit_costs_ms(features, sample.threads, sample.factorizations));
    terms.push_back(ExpectedFactorizations::terms(features));
  }
  cost.factorizations = fit_factorizations(samples, terms);
  cost.active_share = fit_active_share(cut);
  for (int group = 0; group < kCostGroups; ++group) fit_group(samples, units, group, cost);
  scale_to_whole(samples, units, cost);
  return cost;
}

double modelled_ms(const CostSample& sample, const KernelCost& cost, Knowledge known) {
  if (known == Knowledge::of_partition)
    return modelled_ms(features_of(sample, cost.active_share.of(sample.graph)), cost);
  KernelCost own = cost;
  own.factorizations = ExpectedFactorizations::always(sample.factorizations);
  return modelled_ms(features_of(sample, sample.active_share), own);
}

double median_error(std::span<const CostSample> samples, const KernelCost& cost, Knowledge known) {
  std::vector<double> errors;
  for (const CostSample& sample : samples)
    errors.push_back(std::abs(modelled_ms(sample, cost, known) / sample.t_s_ms - 1));
  return lower_median(std::move(errors));
}

double median_cell_error(std::span<const CostSample> samples, const KernelCost& cost) {
  struct Sums {
    double modelled_ms = 0, measured_ms = 0;
  };
  std::map<int, Sums> cells;
  for (const CostSample& sample : samples) {
    Sums& sums = cells[sample.cell];
    sums.modelled_ms += modelled_ms(sample, cost, Knowledge::of_partition);
    sums.measured_ms += sample.t_s_ms;
  }
  std::vector<double> errors;
  for (const auto& [cell, sums] : cells) errors.push_back(std::abs(sums.modelled_ms / sums.measured_ms - 1));
  return lower_median(std::move(errors));
}

}  // namespace cleave
