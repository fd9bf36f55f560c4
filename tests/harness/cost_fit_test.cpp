// Fits of the cost model: the least-squares method against every set of active bounds, coefficients that are
// found again, and counted work against what the kernels count themselves.
#include "harness/experiment/cost_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "harness/base/nonnegative_least_squares.h"
#include "harness/experiment/problem_graph.h"
#include "harness/experiment/simulation.h"
#include "tests/solver/seeded_random.h"

namespace cleave {
namespace {

// Gaussian elimination with pivoting; false where the matrix is singular.
bool solve(std::vector<std::vector<double>> matrix, std::vector<double>& x) {
  const std::size_t n = x.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(matrix[i][k]) > std::abs(matrix[pivot][k])) pivot = i;
    if (std::abs(matrix[pivot][k]) < 1e-12) return false;
    std::swap(matrix[k], matrix[pivot]);
    std::swap(x[k], x[pivot]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = matrix[i][k] / matrix[k][k];
      for (std::size_t j = k; j < n; ++j) matrix[i][j] -= factor * matrix[k][j];
      x[i] -= factor * x[k];
    }
  }
  for (std::size_t k = 0; k < n; ++k) x[k] /= matrix[k][k];
  return true;
}

double squared_distance(std::span<const double> a, std::span<const double> b, std::span<const double> x) {
  double sum = 0;
  for (std::size_t row = 0; row < b.size(); ++row) {
    double difference = -b[row];
    for (std::size_t k = 0; k < x.size(); ++k) difference += a[row * x.size() + k] * x[k];
    sum += difference * difference;
  }
  return sum;
}

// The best of all sets of unknowns that are not 0.
double least_of_all_sets(std::span<const double> a, std::span<const double> b, int n) {
  double least = squared_distance(a, b, std::vector<double>(n, 0.0));
  for (int set = 1; set < 1 << n; ++set) {
    std::vector<int> chosen;
    for (int k = 0; k < n; ++k)
      if (set >> k & 1) chosen.push_back(k);
    std::vector<std::vector<double>> matrix(chosen.size(), std::vector<double>(chosen.size(), 0.0));
    std::vector<double> x(chosen.size(), 0.0), whole(n, 0.0);
    for (std::size_t row = 0; row < b.size(); ++row)
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        x[i] += a[row * n + chosen[i]] * b[row];
        for (std::size_t j = 0; j < chosen.size(); ++j)
          matrix[i][j] += a[row * n + chosen[i]] * a[row * n + chosen[j]];
      }
    if (!solve(matrix, x)) continue;
    bool allowed = true;
    for (std::size_t i = 0; i < chosen.size(); ++i) whole[chosen[i]] = x[i], allowed &= x[i] >= 0;
    if (allowed) least = std::min(least, squared_distance(a, b, whole));
  }
  return least;
}

TEST(NonnegativeLeastSquares, IsTheBestOfAllSets) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SeededRandom random(seed);
    const int n = random.integer(1, 7), rows = random.integer(n, 25);
    std::vector<double> a(n * rows), b(rows);
    for (std::size_t k = 0; k < a.size(); ++k) a[k] = random.uniform(-0.3, 1) * std::pow(10.0, k % n);
    for (double& value : b) value = random.uniform(-0.2, 1);
    const std::vector<double> x = nonnegative_least_squares(a, b, n);
    for (const double value : x) ASSERT_GE(value, 0);
    const double least = least_of_all_sets(a, b, n);
    EXPECT_NEAR(squared_distance(a, b, x), least, 1e-8 * (1 + least)) << "seed " << seed;
  }
}

TEST(NonnegativeLeastSquares, GivesAColumnOfZerosNothing) {
  const std::vector<double> x =
      nonnegative_least_squares(std::vector{1.0, 0.0, 2.0, 0.0}, std::vector{3.0, 6.0}, 2);
  EXPECT_NEAR(x[0], 3, 1e-9);
  EXPECT_EQ(x[1], 0);
}

TEST(CostFit, FindsTheSizeOfAnInterface) {
  for (const double n : {0.0, 1.0, 2.0, 7.0, 120.0, 5000.0})
    EXPECT_NEAR(interface_size(n * (n + 1) * (2 * n + 1) / 6), n, 1e-9 * (1 + n));
}

// Bodies in a grid, each touching those beside and below it, dealt at random into parts.
CostSample sample_with(const KernelCost& truth, std::uint64_t seed) {
  SeededRandom random(seed);
  const int width = random.integer(2, 12), height = random.integer(2, 8), parts = random.integer(1, width);
  std::vector<ConstraintLink> links;
  for (int i = 0; i < width * height; ++i) {
    if (i % width > 0) links.push_back({i, i - 1, random.integer(1, 12)});
    links.push_back({i, i < width ? -1 : i - width, random.integer(1, 12)});
  }
  std::vector<double> mass_kg(width * height, 1.0);
  if (random.chance(0.5))
    for (double& mass : mass_kg) mass = random.log_uniform(1, 1000);
  CostSample sample{BodyGraph(mass_kg, links), {}, truth.kernel, truth.threads};
  sample.parts.part_count = parts;
  for (int i = 0; i < width * height; ++i)
    sample.parts.part_of_body.push_back(i < parts ? i : random.integer(0, parts - 1));
  sample.factorizations = random.integer(2, 9);
  sample.active_share = random.uniform(0.3, 0.9);
  sample.t_s_ms = modelled_ms(sample, truth, Knowledge::of_sample);
  const CostFeatures features =
      CostCounter(sample.graph, truth.kernel, sample.active_share).count(sample.parts);
  const auto units = unit_costs_ms(features, truth.threads, sample.factorizations);
  for (int t = 0; t < kCostTerms; ++t)
    sample.group_ms[static_cast<int>(cost_terms()[t].group)] += truth.cost[t] * units[t];
  return sample;
}

TEST(CostFit, FindsTheCostsThatMadeTheTimes) {
  for (const int threads : {1, 2}) {
    KernelCost truth{
        CostKernel::schur_rows, threads, {}, {}, {20, 900, 50, 80, 0.4, 40, 30, 0.15, 0.1, 0.05, 0.5, 300}};
    std::vector<CostSample> fitted, others;
    for (std::uint64_t seed = 0; seed < 60; ++seed)
      (seed % 2 == 0 ? fitted : others).push_back(sample_with(truth, seed));
    const KernelCost found = fit_cost(fitted);
    EXPECT_LT(median_error(others, found, Knowledge::of_sample), 1e-3);
    EXPECT_GT(median_error(others, found, Knowledge::of_partition), 1e-2);  // their factorisations are drawn
    EXPECT_GE(found.factorizations.most, 2);
    EXPECT_LE(found.factorizations.most, 15);
  }
  EXPECT_TRUE(std::isnan(median_error({}, {}, Knowledge::of_sample)));
}

// Time that no stage has, of most solves a quarter, is spread over all terms.
TEST(CostFit, HalfOfTheSolvesTakeMoreThanModelled) {
  const KernelCost truth{
      CostKernel::schur_rows, 1, {}, {}, {20, 900, 50, 80, 0.4, 40, 30, 0.15, 0.1, 0.05, 0.5, 300}};
  std::vector<CostSample> samples;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    samples.push_back(sample_with(truth, seed));
    samples.back().t_s_ms *= seed % 4 == 0 ? 2 : 1.25;
  }
  const KernelCost found = fit_cost(samples);
  EXPECT_LT(median_error(samples, found, Knowledge::of_sample), 1e-3);
}

// Two solves of a cell of which one takes a fifth less than modelled and one a fifth more, and a cell of its
// own.
TEST(CostFit, StepsOfACellMakeUpForEachOther) {
  const KernelCost truth{CostKernel::schur_rows,
                         1,
                         ExpectedFactorizations::always(3),
                         ExpectedActiveShare::always(0.5),
                         {20, 900, 50, 80, 0.4, 40, 30, 0.15, 0.1, 0.05, 0.5, 300}};
  std::vector<CostSample> samples;
  for (const double share : {0.8, 1.2, 1.1}) {
    samples.push_back(sample_with(truth, 1));
    samples.back().t_s_ms = share * modelled_ms(samples.back(), truth, Knowledge::of_partition);
    samples.back().cell = samples.size() < 3 ? 1 : 2;
  }
  EXPECT_NEAR(median_cell_error(std::span(samples).first(2), truth), 0, 1e-12);
  EXPECT_NEAR(median_cell_error(std::span(samples).last(1), truth), 1 - 1 / 1.1, 1e-12);
  EXPECT_NEAR(median_error(samples, truth, Knowledge::of_partition), 1 - 1 / 1.2,
              1e-12);  // of 1 / 0.8 - 1, 1 - 1 / 1.2 and 1 - 1 / 1.1
}

// As many as the law says, rounded, but for a few steps that factor ten times as often.
TEST(CostFit, FindsHowOftenAStepFactors) {
  const ExpectedFactorizations law{-0.6, 0.9, -0.5, 0.4, 0.1, 50};
  const KernelCost truth{
      CostKernel::schur_rows, 1, {}, {}, {20, 900, 50, 80, 0.4, 40, 30, 0.15, 0.1, 0.05, 0.5, 300}};
  std::vector<CostSample> samples;
  std::vector<CostFeatures> features;
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    samples.push_back(sample_with(truth, seed));
    CostSample& sample = samples.back();
    features.push_back(CostCounter(sample.graph, truth.kernel, sample.active_share).count(sample.parts));
    sample.factorizations = static_cast<int>(std::lround(law.of(features.back()))) * (seed % 9 == 0 ? 10 : 1);
  }
  const ExpectedFactorizations found = fit_cost(samples).factorizations;
  double most = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    EXPECT_NEAR(found.of(features[k]), law.of(features[k]), 0.6) << "seed " << k;
    most = std::max(most, found.of(features[k]));
  }
  EXPECT_GT(most, 4);
  EXPECT_NEAR(found.most, most, 1e-9);
}

// As many active rows as the law says, but for a few steps in which all are.
TEST(CostFit, FindsTheShareOfActiveRows) {
  const ExpectedActiveShare law{0.9, 1.7, 0.3};
  const KernelCost truth{
      CostKernel::schur_rows, 1, {}, {}, {20, 900, 50, 80, 0.4, 40, 30, 0.15, 0.1, 0.05, 0.5, 300}};
  std::vector<CostSample> samples;
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    samples.push_back(sample_with(truth, seed));
    samples.back().active_share = seed % 9 == 0 ? 1 : law.of(samples.back().graph);
  }
  const ExpectedActiveShare found = fit_cost(samples).active_share;
  for (const CostSample& sample : samples) EXPECT_NEAR(found.of(sample.graph), law.of(sample.graph), 0.02);
}

// Steps that are all alike tell nothing about rows and degree.
TEST(CostFit, IsFiniteWhereStepsAreAlike) {
  const KernelCost truth{
      CostKernel::schur_rows, 1, {}, {}, {20, 900, 50, 80, 0.4, 40, 30, 0.15, 0.1, 0.05, 0.5, 300}};
  const CostSample sample = sample_with(truth, 3);
  const std::vector<CostSample> samples(5, sample);
  const CostFeatures features =
      CostCounter(sample.graph, truth.kernel, sample.active_share).count(sample.parts);
  EXPECT_NEAR(fit_cost(samples).factorizations.of(features), sample.factorizations, 1e-9);
}

bool has_covers(CostKernel kernel) {
  return kernel == CostKernel::schur_bodies || kernel == CostKernel::schur_nested;
}

// Orders of elimination differ, so do the counts by some percent; where bodies are cut the covers do too.
void expect_near_the_kernels(const StepRecord& row, const Outcome& outcome, const BodyGraph& graph) {
  const auto names = cost_kernel_names();
  const auto kernel = static_cast<CostKernel>(std::ranges::find(names, row.kernel) - names.begin());
  const bool whole = kernel == CostKernel::monolithic;
  const Partition parts = whole ? Partition{std::vector<int>(graph.body_count(), 0), 1} : outcome.parts;
  const CostFeatures features = CostCounter(graph, kernel, 1).count(parts);
  double flops = 0, counted_mflop = row.factor_mflop_local;
  for (const PartCost& part : features.parts) flops += part.factor_flops;
  EXPECT_EQ(features.rows, row.rows);
  EXPECT_EQ(features.cut_rows, whole ? 0 : row.interface_rows);
  if (kernel == CostKernel::schur_rows) {
    EXPECT_EQ(features.interface_unknowns, row.interface_unknowns);
  } else {
    flops += features.interface_flops;
    counted_mflop += row.factor_mflop_interface;
  }
  EXPECT_NEAR(1e-6 * flops / counted_mflop, 1, has_covers(kernel) ? 0.35 : 0.1);
}

TEST(CostFeatures, AreNearWhatTheKernelsCount) {
  const RunOptions options = parse_run_options(
      {{"scene", "rock_pile"},
       {"bodies", "120"},
       {"partitioner", "mindp,mix"},
       {"refiner", "none,fm"},
       {"solver", "pivot:schur-rows,pivot:schur-bodies,pivot:schur-nested,pivot:monolithic"},
       {"repeats", "1"},
       {"steps", "120"},
       {"measure-every", "40"},
       {"out", "-"}});
  int rows = 0;
  const std::atomic<bool> stop = false;
  const auto observe = [&](const ObservedStep& step) {
    const BodyGraph graph = body_graph_of(step.problem);
    for (std::size_t i = 0; i < step.rows.size(); ++i) {
      SCOPED_TRACE(step.rows[i].partitioner + "+" + step.rows[i].refiner + "+" + step.rows[i].solver);
      if (graph.edge_count() < 100) continue;
      expect_near_the_kernels(step.rows[i], step.outcomes[i], graph);
      ++rows;
    }
  };
  Simulation(options, stop, observe).run([](auto) {}, [](int, int) {});
  EXPECT_GE(rows, 9);
}

}  // namespace
}  // namespace cleave
