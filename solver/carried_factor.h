// A kernel whose factor serves on: for later weights and later steps with the same bodies, H dv = f is solved
// by conjugate gradients that the last factor preconditions (Hestenes and Stiefel 1952; Concus, Golub,
// O'Leary 1976),
//
//     iterations ~ eigenvalues of H_factored^-1 H that are not near 1
//                ~ rows that came, went, or changed sides,
//
// and the factorisation is made anew where that is cheaper. Which it is is decided by counted arithmetic,
// never by time, so that a run takes the same way on every machine. What comes out is not exact to rounding
// but to kCarriedAccuracy; strategies refine it, as they do the answers of a factor.
//
// Only the factor and its analysis are carried; rows are always those of the step at hand.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "solver/body_system.h"
#include "solver/kernels/kernel.h"

namespace cleave {

// Share of the right-hand side, in the norm of the factor, that conjugate gradients leave.
inline constexpr double kCarriedAccuracy = 1e-8;
// What a flop of a product, a substitution or an assembly costs in flops of a factorisation, whose numbers
// stay in the cache: 3.3 to 4 Gflop/s against 10.7 on a pile of 800 boxes (one core, AVX-512).
inline constexpr double kFlopsOfAProduct = 3;

class CarriedFactor : public Kernel {
 public:
  explicit CarriedFactor(std::unique_ptr<Kernel> kernel) : kernel_(std::move(kernel)) {}

  // Of one step; factor_reuses: systems that were solved without a factorisation of their own.
  struct Counts {
    int factorizations = 0, factor_reuses = 0, cg_iterations = 0;
    double mflop_done = 0;  // of the factorisations
  };
  // changed_rows: how many of the step before ended on another side than they had begun; as many are expected
  // now.
  void begin_step(int changed_rows);
  const Counts& counts() const { return counts_; }
  // The next system is factored.
  void forget() { has_factor_ = is_own_ = false; }

  void analyze(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) override;
  bool analyzes_as_a_task() const override { return kernel_->analyzes_as_a_task(); }
  // Always true with a factor at hand: new pairs of bodies find their place at the next factorisation.
  bool rebind(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) override;
  bool factor(const RowWeights& weights, ParallelTasks& tasks, const RowWork& before = {}) override;
  void solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
             std::span<double> dlambda, ParallelTasks& tasks, const RowsAround& around = {}) override;
  int interface_unknowns() const override { return kernel_->interface_unknowns(); }
  double local_mflop() const override { return kernel_->local_mflop(); }
  double interface_mflop() const override { return kernel_->interface_mflop(); }

 private:
  void bind(const PreparedStep& step, const Parts& parts);
  bool factor_anew(ParallelTasks& tasks);
  bool pays_to_factor() const;
  double iteration_mflop() const;
  double anew_mflop() const;
  bool iterate(int most, ParallelTasks& tasks);
  template <class Action>
  void over_components(ParallelTasks& tasks, const Action& action);
  double dot(std::span<const double> a, std::span<const double> b, ParallelTasks& tasks);

  std::unique_ptr<Kernel> kernel_;
  const PreparedStep* step_ = nullptr;
  Parts parts_;
  BodySystem system_;
  std::vector<double> factored_d_;  // (m) weights of the factor
  std::vector<WeightBlock> blocks_;
  bool has_factor_ = false, fits_ = false;  // fits_: the analysis is of these rows
  bool is_own_ = false;                     // the factor is that of the weights at hand
  bool is_of_step_ = false;                 // it was made in this step
  int expected_changes_ = 0;                // of rows since the factorisation of another step
  Counts counts_;
  std::vector<double> x_, residual_, direction_, image_;  // (n, 6)
  std::vector<double> chunk_sums_;
};

}  // namespace cleave
