// A kernel that is dear to factor and cheap to apply, so that its factor is carried.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "tests/solver/kernel_wrapper.h"

namespace cleave {

// Where a wrong factor is planted, what is carried is that of another matrix: diagonal, with entries of this
// sign and size. mflop: what a factorisation is said to take.
class Dear : public KernelWrapper {
 public:
  explicit Dear(std::optional<double> planted = {},
                std::unique_ptr<Kernel> kernel = make_monolithic_kernel(Settings()), double mflop = 1e3)
      : KernelWrapper(std::move(kernel)), planted_(planted), mflop_(mflop) {}
  double local_mflop() const override { return mflop_; }
  double apply_mflop() const override { return 0; }
  void apply_factor(std::span<const double> f, std::span<double> x, ParallelTasks& tasks) override {
    if (!planted_) return KernelWrapper::apply_factor(f, x, tasks);
    for (std::size_t k = 0; k < f.size(); ++k) x[k] = *planted_ * f[k] * static_cast<double>(1 + k % 7);
  }

 private:
  std::optional<double> planted_;
  double mflop_;
};

}  // namespace cleave
