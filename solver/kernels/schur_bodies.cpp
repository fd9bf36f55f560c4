// Kernel `schur-bodies`: the interface in body space. A vertex cover of the cut edges (vertex_cover.h) is the
// interface; without those bodies the parts share no row, so with interiors I_1..I_p and cover K
//
//     H = | H_11           H_1K |      S = H_KK - sum_i H_Ki H_ii^-1 H_iK     (block-sparse)
//         |       H_22     H_2K |
//         | H_K1  H_K2 ... H_KK |
//
// interiors are eliminated in parallel, then S. This is one sparse Cholesky factorisation whose order is constrained to
// interiors first, so it needs no J H^-1 J^T, and stays factorable where all cut rows are active.
#include <algorithm>
#include <utility>
#include <vector>

#include "solver/kernels/branch_kernel.h"
#include "solver/vertex_cover.h"

namespace cleave {
namespace {

class SchurBodiesKernel : public BranchKernel {
  void choose_stages(const PreparedStep& step, std::span<const int> part_of_body, Stages& stages) override;

  std::vector<std::pair<int, int>> cut_edges_;
};

void SchurBodiesKernel::choose_stages(const PreparedStep& step, std::span<const int> part_of_body,
                                      Stages& stages) {
  cut_edges_.clear();
  for (const RowGroup& group : step.groups()) {
    if (group.body_b >= 0 && part_of_body[group.body_a] != part_of_body[group.body_b]) {
      cut_edges_.emplace_back(group.body_a, group.body_b);
    }
  }
  stages.of_body.assign(part_of_body.begin(), part_of_body.end());
  stages.first_of_interface = part_of_body.empty() ? 0 : *std::ranges::max_element(part_of_body) + 1;
  stages.count = stages.first_of_interface + 1;
  const std::vector<char> cover = vertex_cover(step.body_count(), cut_edges_);
  for (std::size_t body = 0; body < cover.size(); ++body) {
    if (cover[body]) stages.of_body[body] = stages.first_of_interface;
  }
}

}  // namespace

std::unique_ptr<Kernel> make_schur_bodies_kernel(const Settings&) {
  return std::make_unique<SchurBodiesKernel>();
}

}  // namespace cleave
