// Kernel `monolithic`: one sparse block Cholesky factorisation of H = M + J^T D J over all bodies, in a
// fill-reducing order that is found once per pattern.
#include <algorithm>
#include <vector>

#include "solver/block_matrix.h"
#include "solver/kernels/kernel.h"

namespace cleave {
namespace {

class MonolithicKernel : public Kernel {
 public:
  void analyze(const PreparedStep& step, std::span<const int>, ParallelTasks& tasks) override {
    StageTimer timer(tasks.clock(), Stage::analyze);
    bind(step);
    matrix_.analyze_whole(step);
  }

  bool rebind(const PreparedStep& step, std::span<const int>, ParallelTasks& tasks) override {
    StageTimer timer(tasks.clock(), Stage::analyze);
    bind(step);
    return matrix_.rebind_whole(step);
  }

  bool factor(const RowWeights& weights, ParallelTasks& tasks) override {
    {
      StageTimer timer(tasks.clock(), Stage::assemble);
      rows_.set(step_->problem(), weights);
      matrix_.assemble(rows_, 0);
    }
    StageTimer timer(tasks.clock(), Stage::factor_local);
    return matrix_.factor(0);
  }

  void solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
             std::span<double> dlambda, ParallelTasks& tasks) override {
    StageTimer timer(tasks.clock(), Stage::solve);
    const std::span<const double> d = rows_.d();
    for (std::size_t r = 0; r < d.size(); ++r) weighted_[r] = d[r] * f_r[r];
    rows_.from_basis(weighted_);
    std::copy(f_v.begin(), f_v.end(), dv.begin());
    step_->add_jacobian_transpose(weighted_, dv);
    matrix_.cholesky().solve(dv);
    step_->jacobian_times(dv, dlambda);
    rows_.to_basis(dlambda);
    for (std::size_t r = 0; r < d.size(); ++r) dlambda[r] = d[r] * (f_r[r] - dlambda[r]);
  }

  double local_mflop() const override { return matrix_.cholesky().symbolic().factor_flops(0) * 1e-6; }

 private:
  void bind(const PreparedStep& step) {
    step_ = &step;
    weighted_.resize(step.row_count());
  }

  const PreparedStep* step_ = nullptr;
  BlockMatrix matrix_;
  WeightedRows rows_;
  std::vector<double> weighted_;
};

}  // namespace

std::unique_ptr<Kernel> make_monolithic_kernel(const Settings&) {
  return std::make_unique<MonolithicKernel>();
}

}  // namespace cleave
