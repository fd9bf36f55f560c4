// Fits the cost model (partition/cost_model.h) to measured solves, and says how far it is off.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "partition/cost_model.h"

namespace cleave {

// One measured solve.
struct CostSample {
  BodyGraph graph;
  Partition parts;
  CostKernel kernel = CostKernel::schur_rows;
  int threads = 1;
  double t_s_ms = 0;
  std::array<double, kCostGroups> group_ms{};  // of which in the stages of each group
  int factorizations = 0;
  double active_share = 1;  // of the cut rows, those that were in the interface of schur-rows
  int cell = 0;             // the same for all steps of a scene with one way to split them
};

// The number of rows of a dense interface whose factorisation takes so many flops, as cost_features.h counts
// them.
double interface_size(double flops);

// Samples of one kernel and number of threads, at least one. The expected factorisations and, of schur-rows,
// the expected share of active rows are fitted to theirs by least absolute error of the logarithm. Each group
// of terms is fitted to the times of its own stages, with what each sample really factored: nonnegative
// coefficients of least absolute error as a share of the whole solve; then all are scaled, so that half of
// the solves take more than modelled.
KernelCost fit_cost(std::span<const CostSample> samples);

// What a modelled time stands on: the sample's own number of factorisations and share of active rows, or the
// expected ones, from the partition alone.
enum class Knowledge { of_sample, of_partition };
double modelled_ms(const CostSample& sample, const KernelCost& cost, Knowledge known);

// Median (the lower middle one of an even number) of |modelled / measured - 1|; NaN without samples.
double median_error(std::span<const CostSample> samples, const KernelCost& cost, Knowledge known);
// The same of cells, each with the sums over its solves, from the partition alone: what a choice for a scene
// stands on, where steps that take more factorisations and fewer make up for each other.
double median_cell_error(std::span<const CostSample> samples, const KernelCost& cost);

}  // namespace cleave
