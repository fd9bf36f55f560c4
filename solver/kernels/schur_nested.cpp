// Kernel `schur-nested`: parts in a tree, and an interface in body space at every level. With the bodies of a
// node of the tree in K (separators.h) and those of the subtrees below it in I_1..I_p, each level is the
// system of schur-bodies,
//
//     S = H_KK - sum_i H_Ki H_ii^-1 H_iK     (block-sparse),
//
// where H_ii is itself eliminated in this way: the tree of parts is the elimination tree, and no dense
// interface of all cut rows is ever formed. Source: George, "Nested dissection of a regular finite element
// mesh", SIAM J. Numer. Anal. 10, 1973; the tree by recursion, Karypis and Kumar 1998.
#include "solver/kernels/branch_kernel.h"

namespace cleave {
namespace {

class SchurNestedKernel : public BranchKernel {
  void choose_stages(const PreparedStep& step, const Parts& parts, Stages& stages) override {
    choose_separators(step, parts, stages);
  }
};

}  // namespace

std::unique_ptr<Kernel> make_schur_nested_kernel(const Settings&) {
  return std::make_unique<SchurNestedKernel>();
}

}  // namespace cleave
