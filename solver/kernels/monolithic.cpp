// Kernel `monolithic`: one sparse block Cholesky factorisation of H = M + J^T D J over all bodies, in a
// fill-reducing order that is found once per pattern.
#include "solver/kernels/branch_kernel.h"

namespace cleave {
namespace {

class MonolithicKernel : public BranchKernel {
  void choose_stages(const PreparedStep&, const Parts&, Stages&) override {}  // one
};

}  // namespace

std::unique_ptr<Kernel> make_monolithic_kernel(const Settings&) {
  return std::make_unique<MonolithicKernel>();
}

}  // namespace cleave
