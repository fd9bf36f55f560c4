// A kernel that does what another does; tests override what they change.
#pragma once

#include <memory>
#include <span>
#include <utility>

#include "solver/kernels/kernel.h"

namespace cleave {

class KernelWrapper : public Kernel {
 public:
  explicit KernelWrapper(std::unique_ptr<Kernel> kernel) : kernel_(std::move(kernel)) {}
  void analyze(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) override {
    step_ = &step;
    kernel_->analyze(step, parts, tasks);
  }
  bool analyzes_as_a_task() const override { return kernel_->analyzes_as_a_task(); }
  bool rebind(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) override {
    step_ = &step;
    return kernel_->rebind(step, parts, tasks);
  }
  bool factor(const RowWeights& weights, ParallelTasks& tasks, const RowWork& before) override {
    return kernel_->factor(weights, tasks, before);
  }
  void solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
             std::span<double> dlambda, ParallelTasks& tasks, const RowsAround& around) override {
    kernel_->solve(f_v, f_r, dv, dlambda, tasks, around);
  }
  double local_mflop() const override { return kernel_->local_mflop(); }
  double done_mflop() const override { return kernel_->done_mflop(); }
  bool can_be_carried() const override { return kernel_->can_be_carried(); }
  void apply_factor(std::span<const double> f, std::span<double> x, ParallelTasks& tasks) override {
    kernel_->apply_factor(f, x, tasks);
  }
  double apply_mflop() const override { return kernel_->apply_mflop(); }

 protected:
  const PreparedStep* step_ = nullptr;

 private:
  std::unique_ptr<Kernel> kernel_;
};

}  // namespace cleave
