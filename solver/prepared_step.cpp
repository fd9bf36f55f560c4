#include "solver/prepared_step.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/counting_sort.h"
#include "solver/group_products.h"

namespace cleave {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Of rows a chunk is a sixteenth, within limits, so that 16 workers have one each.
constexpr int kMostChunkRows = 512, kChunkBodies = 48;

}  // namespace

template <class Task>
void PreparedStep::run(std::span<const Chunk> chunks, const Task& task) const {
  if (tasks_ != nullptr && chunks.size() > 1) return tasks_->run_over(chunks, task);
  for (const Chunk& chunk : chunks) task(chunk);
}

void PreparedStep::bind(const StepProblem& problem, ParallelTasks* tasks) {
  ++preparations_;
  problem_ = &problem;
  tasks_ = tasks;
  list_groups();
  set_.bind(problem);
}

void PreparedStep::compute() {
  list_sides();
  list_chunks();
  const std::size_t n = body_count(), m = row_count();
  group_sums_.resize(12 * groups_.size());
  inverse_mass_.resize(36 * n);
  mass_jacobian_.resize(12 * m);
  diagonal_.resize(m);
  inverse_diagonal_.resize(m);
  run(body_chunks_, [this](const Chunk& chunk) { prepare_bodies(chunk); });
  run(group_chunks_, [this](const Chunk& chunk) { prepare_rows(chunk); });
  turn_diagonal();
  level_diagonal();
  invert_diagonal();
  velocity_scale_ = 1;
  for (double v : problem_->free_velocity) velocity_scale_ = std::max(velocity_scale_, std::abs(v));
}

void PreparedStep::list_groups() {
  groups_.clear();
  for (int r = 0; r < row_count(); ++r) {
    const int a = problem_->row_body[2 * r], b = problem_->row_body[2 * r + 1];
    if (groups_.empty() || groups_.back().body_a != a || groups_.back().body_b != b)
      groups_.push_back({a, b, r, 0});
    ++groups_.back().row_count;
  }
}

void PreparedStep::list_sides() {
  const auto body_of_side = [this](int side) {
    const RowGroup& g = groups_[side / 2];
    return side % 2 == 0 ? g.body_a : g.body_b;
  };
  sort_into_buckets(static_cast<int>(2 * groups_.size()), body_count(), body_of_side, side_first_, sides_);
}

void PreparedStep::list_chunks() {
  cut_into_chunks(
      static_cast<int>(groups_.size()), std::clamp((row_count() + 15) / 16, kLeastChunkRows, kMostChunkRows),
      [&](int g) { return groups_[g].row_count; }, group_chunks_);
  cut_into_chunks(
      body_count(), kChunkBodies, [](int) { return 1; }, body_chunks_);
}

void PreparedStep::prepare_bodies(const Chunk& chunk) {
  for (int i = chunk.first; i < chunk.last; ++i) {
    const Eigen::Map<const Matrix6> mass(problem_->mass.data() + 36L * i);
    Eigen::Map<Matrix6>(inverse_mass_.data() + 36L * i) = mass.llt().solve(Matrix6::Identity());
  }
}

void PreparedStep::prepare_rows(const Chunk& chunk) {
  const auto [first, last] = rows_of(chunk);
  for (int r = first; r < last; ++r) {
    double d = problem_->compliance[r];
    for (int side = 0; side < 2; ++side) {
      const int body = problem_->row_body[2 * r + side];
      Eigen::Map<Vector6> mj(mass_jacobian_.data() + 12L * r + 6 * side);
      if (body < 0) {
        mj.setZero();
        continue;
      }
      const Eigen::Map<const Vector6> j(problem_->jacobian.data() + 12L * r + 6 * side);
      mj = Eigen::Map<const Matrix6>(inverse_mass_.data() + 36L * body) * j;
      d += j.dot(mj);
    }
    diagonal_[r] = d > 0 ? d : 1;  // a row of zeros constrains nothing
  }
}

// On the rows of a turned box, d_k = f^T (J M^-1 J^T + C) f along each axis f.
void PreparedStep::turn_diagonal() {
  for (const WeightBlock& block : set_.axes()) {
    for (int k = 0; k < block.row_count; ++k) {
      const double* axis = block.basis.data() + block.row_count * k;
      double j[12] = {}, mj[12] = {}, d = 0;
      for (int i = 0; i < block.row_count; ++i) {
        const int row = block.first_row + i;
        d += axis[i] * axis[i] * problem_->compliance[row];
        for (int c = 0; c < 12; ++c) {
          j[c] += axis[i] * problem_->jacobian[12 * row + c];
          mj[c] += axis[i] * mass_jacobian_[12 * row + c];
        }
      }
      for (int c = 0; c < 12; ++c) d += j[c] * mj[c];
      diagonal_[block.first_row + k] = d > 0 ? d : 1;
    }
  }
}

// The rows of a cone have one d.
void PreparedStep::level_diagonal() {
  for (const FrictionCone& cone : set_.cones()) {
    const auto rows = std::span(diagonal_).subspan(cone.first_row, cone.row_count);
    std::ranges::fill(rows, std::ranges::max(rows));
  }
}

void PreparedStep::invert_diagonal() {
  chunk_compliance_.assign(group_chunks_.size(), std::numeric_limits<double>::infinity());
  const RowWork invert = [this](int first, int last, int chunk) {
    double& least = chunk_compliance_[chunk];
    for (int r = first; r < last; ++r) {
      inverse_diagonal_[r] = 1 / diagonal_[r];
      least = std::min(least, problem_->compliance[r] / diagonal_[r]);
    }
  };
  run(group_chunks_, [&](const Chunk& chunk) { do_rows(invert, chunk); });
  least_relative_compliance_ = std::numeric_limits<double>::infinity();
  for (const double least : chunk_compliance_)
    least_relative_compliance_ = std::min(least_relative_compliance_, least);
}

void PreparedStep::velocity(std::span<const double> impulse, std::span<double> v,
                            const RowWork& before) const {
  add_transpose(mass_jacobian_.data(), impulse, problem_->free_velocity, v, before);
}

void PreparedStep::add_jacobian_transpose(std::span<const double> x, std::span<double> out) const {
  add_transpose(problem_->jacobian.data(), x, out, out);
}

// out (n, 6) = base + sum over the rows r of rows_r^T x_r: first the sum of each group, then of each body.
void PreparedStep::add_transpose(const double* rows, std::span<const double> x, std::span<const double> base,
                                 std::span<double> out, const RowWork& before) const {
  run(group_chunks_, [&](const Chunk& chunk) {
    do_rows(before, chunk);
    for (int g = chunk.first; g < chunk.last; ++g) {
      double sum[12];
      sum_rows(
          groups_[g], rows, [&](int r) { return x[r]; }, sum);
      std::copy_n(sum, 12, group_sums_.data() + 12L * g);
    }
  });
  run(body_chunks_, [&](const Chunk& chunk) {
    for (int body = chunk.first; body < chunk.last; ++body)
      add_sides(sides_of_body(body), group_sums_.data(), base.data() + 6L * body, out.data() + 6L * body);
  });
}

void PreparedStep::jacobian_times(std::span<const double> v, std::span<double> out) const {
  run(group_chunks_, [&](const Chunk& chunk) { jacobian_times(chunk, v, out); });
}

void PreparedStep::jacobian_times(const Chunk& chunk, std::span<const double> v,
                                  std::span<double> out) const {
  for (int i = chunk.first; i < chunk.last; ++i) {
    const RowGroup& g = groups_[i];
    const BodyPair both =
        load_pair(v.data() + 6L * g.body_a, g.body_b < 0 ? nullptr : v.data() + 6L * g.body_b);
    visit_products(g, problem_->jacobian.data(), both, [&](int r, auto product) { write(product, &out[r]); });
  }
}

void PreparedStep::slack(std::span<const double> v, std::span<const double> impulse, std::span<double> w,
                         const RowWork& after) const {
  run(group_chunks_, [&](const Chunk& chunk) {
    jacobian_times(chunk, v, w);
    const auto [first, last] = rows_of(chunk);
    for (int r = first; r < last; ++r) w[r] += problem_->compliance[r] * impulse[r] - problem_->rhs[r];
    do_rows(after, chunk);
  });
}

}  // namespace cleave
