// Kernel `dense`: H = M + J^T D J as one dense matrix, formed row by row and factored by Eigen. Slow and
// obvious on purpose: it is the oracle of the other kernels and shares no code with them. The blocks of D are
// written out as 3x3 matrices here.
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <optional>

#include "solver/kernels/kernel.h"
#include "solver/linear/eigen_blocking.h"

namespace cleave {
namespace {

class DenseKernel : public Kernel {
 public:
  void analyze(const PreparedStep& step, const Parts&, ParallelTasks& tasks) override {
    StageTimer timer(tasks.clock(), Stage::analyze);
    request_memory(step, tasks);
    step_ = &step;
    if (mass_.rows() != 6 * step.body_count() || jacobian_.rows() != step.row_count()) release();
  }

  bool rebind(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) override {
    analyze(step, parts, tasks);  // no pattern, so every step fits
    return true;
  }

  bool factor(const RowWeights& weights, ParallelTasks& tasks, const RowWork& before) override {
    run_work(before, *step_, tasks);
    d_ = Eigen::Map<const Eigen::VectorXd>(weights.d.data(), static_cast<Eigen::Index>(weights.d.size()));
    blocks_ = weights.blocks;
    scalar_d_ = d_;
    for (const WeightBlock& block : blocks_) scalar_d_.segment(block.first_row, block.row_count).setZero();
    {
      StageTimer timer(tasks.clock(), Stage::assemble);
      expand();
      h_ = mass_;
      h_.noalias() += jacobian_.transpose() * scalar_d_.asDiagonal() * jacobian_;
      add_blocks();
    }
    StageTimer timer(tasks.clock(), Stage::factor_local);
    factor_->compute(h_);
    return factor_->info() == Eigen::Success;
  }

  void solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
             std::span<double> dlambda, ParallelTasks& tasks, const RowsAround& around) override {
    StageTimer timer(tasks.clock(), Stage::solve);
    run_work(around.before, *step_, tasks);
    const auto size = [](auto s) { return static_cast<Eigen::Index>(s.size()); };
    const Eigen::Map<const Eigen::VectorXd> fv(f_v.data(), size(f_v)), fr(f_r.data(), size(f_r));
    Eigen::Map<Eigen::VectorXd> v(dv.data(), size(dv)), lambda(dlambda.data(), size(dlambda));
    Eigen::VectorXd weighted = d_.cwiseProduct(fr);
    turn_from_basis(weighted);
    v = factor_->solve(fv + jacobian_.transpose() * weighted);
    Eigen::VectorXd row_velocity = jacobian_ * v;
    turn_to_basis(row_velocity);
    lambda = d_.cwiseProduct(fr - row_velocity);
    run_work(around.after, *step_, tasks);
  }

  double local_mflop() const override {
    const double size = static_cast<double>(mass_.rows());
    return size * (size + 1) * (2 * size + 1) / 6 * 1e-6;
  }

 private:
  // A matrix of Eigen that changes its size gives its memory back first and keeps the pointer to it where
  // there is no memory for the new size. One that has none loses nothing.
  void release() {
    mass_ = jacobian_ = h_ = Eigen::MatrixXd();
    d_ = scalar_d_ = Eigen::VectorXd();
    factor_.emplace();
  }

  // M, H and its factor; J and J^T D. What products copy besides is as high as the matrix and of fixed width.
  static void request_memory(const PreparedStep& step, ParallelTasks& tasks) {
    const auto unknowns = 6 * static_cast<std::uint64_t>(step.body_count()),
               rows = static_cast<std::uint64_t>(step.row_count());
    MemoryCount memory;
    memory.add<double>(3 * unknowns, unknowns);
    memory.add<double>(2 * unknowns, rows);
    memory.add<double>(kProductColumns, unknowns);
    memory.add<double>(4, unknowns + rows);
    tasks.memory().request(memory);
  }
  static constexpr int kProductColumns = 256;

  using Basis = Eigen::Map<const Eigen::MatrixXd>;
  static Basis basis_of(const WeightBlock& block) {
    return Basis(block.basis.data(), block.row_count, block.row_count);
  }

  // J^T D J of the blocks.
  void add_blocks() {
    for (const WeightBlock& block : blocks_) {
      const Basis basis = basis_of(block);
      const auto d = d_.segment(block.first_row, block.row_count).asDiagonal();
      const Eigen::MatrixXd written_out = basis * d * basis.transpose();
      const auto rows = jacobian_.middleRows(block.first_row, block.row_count);
      h_.noalias() += rows.transpose() * written_out * rows;
    }
  }

  // x <- B x on the rows of the blocks.
  void turn_from_basis(Eigen::VectorXd& x) const {
    for (const WeightBlock& block : blocks_)
      x.segment(block.first_row, block.row_count) =
          (basis_of(block) * x.segment(block.first_row, block.row_count)).eval();
  }

  // x <- B^T x
  void turn_to_basis(Eigen::VectorXd& x) const {
    for (const WeightBlock& block : blocks_)
      x.segment(block.first_row, block.row_count) =
          (basis_of(block).transpose() * x.segment(block.first_row, block.row_count)).eval();
  }

  // M and J as dense matrices.
  void expand() {
    const StepProblem& problem = step_->problem();
    const int n = step_->body_count(), m = step_->row_count();
    mass_.setZero(6 * n, 6 * n);
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < 36; ++k) mass_(6 * i + k / 6, 6 * i + k % 6) = problem.mass[36 * i + k];
    }
    jacobian_.setZero(m, 6 * n);
    for (int r = 0; r < m; ++r) {
      for (int k = 0; k < 12; ++k) {
        const int body = problem.row_body[2 * r + k / 6];
        if (body >= 0) jacobian_(r, 6 * body + k % 6) = problem.jacobian[12 * r + k];
      }
    }
  }

  const PreparedStep* step_ = nullptr;
  Eigen::MatrixXd mass_, jacobian_, h_;
  Eigen::VectorXd d_, scalar_d_;  // scalar_d: zero on the rows of blocks
  std::span<const WeightBlock> blocks_;
  // Eigen's own move copies a status that is not set before the first factorisation.
  std::optional<Eigen::LLT<Eigen::MatrixXd>> factor_{std::in_place};
};

}  // namespace

std::unique_ptr<Kernel> make_dense_kernel(const Settings&) {
  fix_eigen_blocking();
  return std::make_unique<DenseKernel>();
}

}  // namespace cleave
