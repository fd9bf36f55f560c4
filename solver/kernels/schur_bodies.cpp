// Kernel `schur-bodies`: the interface in body space. A vertex cover of the cut edges (vertex_cover.h) is the
// interface; without those bodies the parts share no row, so with interiors I_1..I_p and cover K
//
//     H = | H_11           H_1K |      S = H_KK - sum_i H_Ki H_ii^-1 H_iK     (block-sparse)
//         |       H_22     H_2K |
//         | H_K1  H_K2 ... H_KK |
//
// interiors are eliminated in parallel, then S. This is one sparse Cholesky factorisation whose order is
// constrained to interiors first, so it needs no J H^-1 J^T, and stays factorable where all cut rows are
// active.
#include "solver/kernels/branch_kernel.h"

namespace cleave {
namespace {

class SchurBodiesKernel : public BranchKernel {
  void choose_stages(const PreparedStep& step, const Parts& parts, Stages& stages) override {
    choose_separators(step, parts.part_of_body, stages);
  }
};

}  // namespace

std::unique_ptr<Kernel> make_schur_bodies_kernel(const Settings&) {
  return std::make_unique<SchurBodiesKernel>();
}

}  // namespace cleave
