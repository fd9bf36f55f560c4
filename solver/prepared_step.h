// What every strategy and kernel derives from a StepProblem before it iterates: rows grouped by body pair,
// M^-1, J M^-1, the set of impulses and the diagonal of J M^-1 J^T + C along its axes. Fixed during a solve.
#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "solver/chunks.h"
#include "solver/impulse_set.h"
#include "solver/parallel_tasks.h"
#include "solver/step_problem.h"

namespace cleave {

// A run of consecutive rows between the same two bodies; body_b is -1 for static.
struct RowGroup {
  int body_a = 0;
  int body_b = -1;
  int first_row = 0;
  int row_count = 0;
};

// What is done with the rows first .. last - 1 of a chunk of groups, the index of which is the third number.
// Handed to what passes over the rows anyway, it takes no stage of its own, and finds in the cache what that
// has read. Empty: nothing.
using RowWork = std::function<void(int first, int last, int chunk)>;
// Before the rows are read, and after they are written.
struct RowsAround {
  RowWork before, after;
};

class PreparedStep {
 public:
  // problem must outlive this object. Buffers are kept from one problem to the next. tasks: who works on this
  // and on the products below, until the next call; nullptr: the calling thread alone, with the same bytes.
  void prepare(const StepProblem& problem, ParallelTasks* tasks = nullptr) {
    bind(problem, tasks);
    compute();
  }
  // The two halves of it: the groups and the set, all that an analysis of the pattern looks at; and the rest.
  void bind(const StepProblem& problem, ParallelTasks* tasks);
  void compute();

  const StepProblem& problem() const { return *problem_; }
  int body_count() const { return problem_->body_count(); }
  int row_count() const { return problem_->row_count(); }
  std::span<const RowGroup> groups() const { return groups_; }
  // Groups a body is in, ascending: 2 * group + side, side 0 where it is body_a.
  std::span<const int> sides_of_body(int body) const {
    return std::span(sides_).subspan(side_first_[body], side_first_[body + 1] - side_first_[body]);
  }
  std::span<const Chunk> group_chunks() const { return group_chunks_; }
  std::span<const Chunk> body_chunks() const { return body_chunks_; }
  // The rows of a chunk of groups: first .. last - 1.
  std::pair<int, int> rows_of(const Chunk& chunk) const {
    const RowGroup& end = groups_[chunk.last - 1];
    return {groups_[chunk.first].first_row, end.first_row + end.row_count};
  }
  // work on the rows of one of group_chunks().
  void do_rows(const RowWork& work, const Chunk& chunk) const {
    if (!work) return;
    const auto [first, last] = rows_of(chunk);
    work(first, last, static_cast<int>(&chunk - group_chunks_.data()));
  }
  // How often prepare() was called: numbers of J and M stay while this does.
  long preparations() const { return preparations_; }
  // (m, 12) rows of M^-1 J^T, laid out as the Jacobian.
  std::span<const double> mass_jacobian() const { return mass_jacobian_; }
  const ImpulseSet& set() const { return set_; }
  // (m) d_r = (J M^-1 J^T + C)_rr along the axes of the set; on the rows of a cone the largest of theirs.
  std::span<const double> diagonal() const { return diagonal_; }
  std::span<const double> inverse_diagonal() const { return inverse_diagonal_; }
  double velocity_scale() const { return velocity_scale_; }  // max(1, largest |v0|), m/s
  double least_relative_compliance() const {
    return least_relative_compliance_;
  }  // min C_r / d_r; inf without rows
  double exact_limit_m_per_s() const { return kExactLimit * velocity_scale_; }

  // v (n, 6) = v0 + M^-1 J^T lambda; before: may write the lambda of a chunk.
  void velocity(std::span<const double> impulse, std::span<double> v, const RowWork& before = {}) const;
  // out (m) = J v, of all rows or those of a chunk of groups.
  void jacobian_times(std::span<const double> v, std::span<double> out) const;
  void jacobian_times(const Chunk& chunk, std::span<const double> v, std::span<double> out) const;
  // out (n, 6) += J^T x
  void add_jacobian_transpose(std::span<const double> x, std::span<double> out) const;
  // w (m) = J v + C lambda - b; after: with the w of a chunk.
  void slack(std::span<const double> v, std::span<const double> impulse, std::span<double> w,
             const RowWork& after = {}) const;
  // The quantity the judge measures; impulse and w along the axes of the set.
  double residual(std::span<const double> impulse, std::span<const double> w) const {
    return set_.residual(0, row_count(), diagonal_, impulse, w);
  }

 private:
  void list_groups();
  void list_sides();
  void list_chunks();
  void prepare_bodies(const Chunk& chunk);
  void prepare_rows(const Chunk& chunk);
  void turn_diagonal();
  void level_diagonal();
  void invert_diagonal();
  template <class Task>
  void run(std::span<const Chunk> chunks, const Task& task) const;
  void add_transpose(const double* rows, std::span<const double> x, std::span<const double> base,
                     std::span<double> out, const RowWork& before = {}) const;

  const StepProblem* problem_ = nullptr;
  ImpulseSet set_;
  ParallelTasks* tasks_ = nullptr;
  std::vector<RowGroup> groups_;
  std::vector<int> side_first_, sides_;
  std::vector<Chunk> group_chunks_, body_chunks_;
  mutable std::vector<double> group_sums_;  // scratch: (groups, 12)
  std::vector<double> inverse_mass_, mass_jacobian_, diagonal_, inverse_diagonal_;
  std::vector<double> chunk_compliance_;  // the least of C_r / d_r by chunk of groups
  long preparations_ = 0;
  double velocity_scale_ = 1, least_relative_compliance_ = 0;
};

}  // namespace cleave
