// Kernel `schur-bodies`: the interface in body space. A vertex cover of the cut edges (vertex_cover.h) is the
// interface; without those bodies the parts share no row, so with interiors I_1..I_p and cover K
//
//     H = | H_11           H_1K |      S = H_KK - sum_i H_Ki H_ii^-1 H_iK     (block-sparse)
//         |       H_22     H_2K |
//         | H_K1  H_K2 ... H_KK |
//
// interiors are eliminated in parallel, one task a part, then S. This is one sparse Cholesky factorisation
// whose order is constrained to interiors first, so it needs no J H^-1 J^T, and stays factorable where all
// cut rows are active.
#include <algorithm>
#include <vector>

#include "solver/block_matrix.h"
#include "solver/kernels/kernel.h"
#include "solver/vertex_cover.h"

namespace cleave {
namespace {

class SchurBodiesKernel : public Kernel {
 public:
  void analyze(const PreparedStep& step, std::span<const int> part_of_body, ParallelTasks& tasks) override;
  bool rebind(const PreparedStep& step, std::span<const int> part_of_body, ParallelTasks& tasks) override;
  bool factor(const RowWeights& weights, ParallelTasks& tasks) override;
  void solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
             std::span<double> dlambda, ParallelTasks& tasks) override;
  int interface_unknowns() const override { return 6 * cover_bodies_; }
  double local_mflop() const override {
    const BlockSymbolic& symbolic = matrix_.cholesky().symbolic();
    double sum = 0;
    for (int part = 0; part < parts_; ++part) sum += symbolic.factor_flops(part);
    return sum * 1e-6;
  }
  double interface_mflop() const override {
    return matrix_.cholesky().symbolic().factor_flops(parts_) * 1e-6;
  }

 private:
  void bind(const PreparedStep& step, std::span<const int> part_of_body);

  const PreparedStep* step_ = nullptr;
  WeightedRows rows_;
  BlockMatrix matrix_;
  int parts_ = 0, cover_bodies_ = 0;
  std::vector<int> stage_of_body_;
  std::vector<std::pair<int, int>> cut_edges_;
  std::vector<char> factored_;
  std::vector<double> weighted_, by_node_, x_;
  std::vector<std::vector<double>> carry_, scratch_;  // one per part, of its own size
};

// Rows and cut edges of a step.
void SchurBodiesKernel::bind(const PreparedStep& step, std::span<const int> part_of_body) {
  step_ = &step;
  weighted_.resize(step.row_count());
  cut_edges_.clear();
  for (const RowGroup& group : step.groups()) {
    if (group.body_b >= 0 && part_of_body[group.body_a] != part_of_body[group.body_b]) {
      cut_edges_.emplace_back(group.body_a, group.body_b);
    }
  }
}

void SchurBodiesKernel::analyze(const PreparedStep& step, std::span<const int> part_of_body,
                                ParallelTasks& tasks) {
  StageTimer timer(tasks.clock(), Stage::analyze);
  bind(step, part_of_body);
  parts_ = 0;
  for (int part : part_of_body) parts_ = std::max(parts_, part + 1);
  const std::vector<char> cover = vertex_cover(step.body_count(), cut_edges_);
  stage_of_body_.assign(part_of_body.begin(), part_of_body.end());
  cover_bodies_ = 0;
  for (std::size_t body = 0; body < cover.size(); ++body) {
    if (cover[body]) stage_of_body_[body] = parts_, ++cover_bodies_;
  }
  matrix_.analyze_whole(step, stage_of_body_, parts_ + 1);
  factored_.resize(parts_);
  by_node_.resize(6 * static_cast<std::size_t>(step.body_count()));
  if (static_cast<int>(carry_.size()) < parts_) carry_.resize(parts_), scratch_.resize(parts_);
  if (scratch_.empty()) scratch_.resize(1);
}

// The cover stays, so it must touch the new cut edges.
bool SchurBodiesKernel::rebind(const PreparedStep& step, std::span<const int> part_of_body,
                               ParallelTasks& tasks) {
  StageTimer timer(tasks.clock(), Stage::analyze);
  bind(step, part_of_body);
  for (const auto& [a, b] : cut_edges_) {
    if (stage_of_body_[a] != parts_ && stage_of_body_[b] != parts_) return false;
  }
  return matrix_.rebind_whole(step);
}

bool SchurBodiesKernel::factor(const RowWeights& weights, ParallelTasks& tasks) {
  {
    StageTimer timer(tasks.clock(), Stage::assemble);
    rows_.set(step_->problem(), weights);
  }
  tasks.run(Stage::assemble, parts_, [&](int part) { matrix_.assemble(rows_, part); });
  tasks.run(Stage::factor_local, parts_, [&](int part) { factored_[part] = matrix_.factor(part); });
  if (std::ranges::find(factored_, 0) != factored_.end()) return false;
  {
    StageTimer timer(tasks.clock(), Stage::form_interface);
    matrix_.assemble(rows_, parts_);
  }
  StageTimer timer(tasks.clock(), Stage::factor_interface);
  return matrix_.factor(parts_);
}

void SchurBodiesKernel::solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
                              std::span<double> dlambda, ParallelTasks& tasks) {
  const BlockCholesky& cholesky = matrix_.cholesky();
  const std::span<const double> d = rows_.d();
  {
    StageTimer timer(tasks.clock(), Stage::solve);
    for (std::size_t r = 0; r < d.size(); ++r) weighted_[r] = d[r] * f_r[r];
    rows_.from_basis(weighted_);
    std::copy(f_v.begin(), f_v.end(), by_node_.begin());
    step_->add_jacobian_transpose(weighted_, by_node_);
    cholesky.to_positions(by_node_, x_);
  }
  tasks.run(Stage::solve, parts_, [&](int part) {
    carry_[part].assign(6 * cholesky.symbolic().late_positions(part).size(), 0.0);
    cholesky.forward(part, x_.data(), carry_[part].data(), scratch_[part]);
  });
  {
    StageTimer timer(tasks.clock(), Stage::solve);
    for (int part = 0; part < parts_; ++part) {
      const double* carried = carry_[part].data();
      for (int position : cholesky.symbolic().late_positions(part)) {
        for (int c = 0; c < 6; ++c) x_[6 * position + c] += *carried++;
      }
    }
    cholesky.forward(parts_, x_.data(), nullptr, scratch_[0]);
    cholesky.backward(parts_, x_.data(), scratch_[0]);
  }
  tasks.run(Stage::solve, parts_, [&](int part) { cholesky.backward(part, x_.data(), scratch_[part]); });
  StageTimer timer(tasks.clock(), Stage::solve);
  cholesky.to_nodes(x_, dv);
  step_->jacobian_times(dv, dlambda);
  rows_.to_basis(dlambda);
  for (std::size_t r = 0; r < d.size(); ++r) dlambda[r] = d[r] * (f_r[r] - dlambda[r]);
}

}  // namespace

std::unique_ptr<Kernel> make_schur_bodies_kernel(const Settings&) {
  return std::make_unique<SchurBodiesKernel>();
}

}  // namespace cleave
