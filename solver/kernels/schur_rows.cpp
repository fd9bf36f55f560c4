// Kernel `schur-rows`: the parallel solver of the paper. Bodies are split into parts; the rows at the cut are
// the interface. With interior rows only in H_i = M_i + J_i^T D_i J_i (factored in parallel, one task a part)
// and over the cut rows with D_c > 0
//
//     S lambda_c = f_c - sum_i J_ci H_i^-1 g_i,     S = D_c^-1 + sum_i J_ci H_i^-1 J_ci^T      (dense)
//     dv_i = H_i^-1 (g_i + J_ci^T lambda_c),        g_i = f_v,i + J_i^T D_i f_i
//
// Source: Peiret, Andrews, Koevecses, Kry, Teichmann, "Schur complement-based substructuring of stiff
// multibody systems with contact", ACM TOG 2019; Liu and Andrews 2022, section 2. What belongs to one part
// is schur_part.h's. On the rows of a 3x3 block of D, J is J' along its basis (row_weights.h).
//
// Strategies that end near the solution change few weights from one factorisation to the next. Parts without
// a changed row, and what they leave to the interface, stand as they are; S has the bytes of a whole one.
#include <algorithm>
#include <vector>

#include "solver/interface_split.h"
#include "solver/kernels/kernel.h"
#include "solver/kernels/schur_part.h"
#include "solver/linear/dense_cholesky.h"
#include "solver/linear/dense_panel.h"

namespace cleave {
namespace {

class SchurRowsKernel : public Kernel {
 public:
  void analyze(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) override;
  bool rebind(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) override;
  bool factor(const RowWeights& weights, ParallelTasks& tasks, const RowWork& before) override;
  void solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
             std::span<double> dlambda, ParallelTasks& tasks, const RowsAround& around) override;
  int interface_unknowns() const override { return static_cast<int>(split_.cut_rows.size()); }
  double local_mflop() const override;
  double interface_mflop() const override { return interface_.mflop(); }
  double done_mflop() const override;

 private:
  void split(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks);
  void count_interface(MemoryCount& memory) const;
  void allocate(ParallelTasks& tasks);
  void assemble(const RowWeights& weights, ParallelTasks& tasks);
  bool factor_parts(ParallelTasks& tasks);
  void form_interface(ParallelTasks& tasks);
  void number_active_rows();
  void gather_panel(int p);
  void gather_part(const SchurPart& part, int first, int end, double* entries) const;
  void solve_interface(std::span<const double> f_r, std::span<double> dlambda);

  const PreparedStep* step_ = nullptr;
  KeptWeights kept_;
  WeightedRows rows_;
  InterfaceSplit split_;
  std::vector<SchurPart> parts_;     // (at least split_.part_count)
  std::vector<int> row_of_cut_;      // (cut rows) row of S, -1 where D = 0
  std::vector<int> interface_rows_;  // (size of S) rows of the problem
  DenseCholesky interface_;          // S
  std::vector<double> lambda_;       // (size of S)
};

void SchurRowsKernel::split(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) {
  StageTimer timer(tasks.clock(), Stage::analyze);
  step_ = &step;
  split_.split(step, parts.part_of_body);
  // An interface that is too large is known before anything of the parts is.
  MemoryCount memory;
  count_interface(memory);
  tasks.memory().request(memory, false);
  if (static_cast<int>(parts_.size()) < split_.part_count) parts_.resize(split_.part_count);
  row_of_cut_.resize(split_.cut_rows.size());
}

// With every cut row in the interface.
void SchurRowsKernel::count_interface(MemoryCount& memory) const {
  const std::size_t cut_rows = split_.cut_rows.size();
  DenseCholesky::count(static_cast<int>(cut_rows), memory);
  memory.add<double>(cut_rows);            // lambda
  memory.add<double>(step_->row_count());  // weights
  memory.add<int>(cut_rows);               // its row of S
  memory.add<int>(cut_rows);               // its row of the problem
  memory.add_grown(split_.local_of_body, split_.cut_rows);
  if (step_->set().has_blocks()) memory.add<double>(12, step_->row_count());
  for (int i = 0; i < split_.part_count; ++i) {
    const PartRows& rows = split_.parts[i];
    memory.add_grown(rows.bodies, rows.groups, rows.cut_rows, rows.cut_side);
    SchurPart::count_right_hand_sides(rows, memory);
  }
}

// Of the parts, once they are analysed.
void SchurRowsKernel::allocate(ParallelTasks& tasks) {
  MemoryCount memory;
  count_interface(memory);
  memory.add_grown(parts_);
  bool analyzed_all = true;
  for (int i = 0; i < split_.part_count; ++i) {
    parts_[i].count(memory);
    analyzed_all &= parts_[i].is_analyzed();
  }
  tasks.memory().request(memory, analyzed_all);
  kept_.bind(*step_);
  tasks.run(Stage::analyze, split_.part_count, [&](int i) { parts_[i].allocate(); });
}

void SchurRowsKernel::analyze(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) {
  split(step, parts, tasks);
  tasks.run(Stage::analyze, split_.part_count,
            [&](int i) { parts_[i].analyze(step, split_, i, tasks.memory().limit_bytes()); });
  allocate(tasks);
}

// Every part decides for itself.
bool SchurRowsKernel::rebind(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) {
  split(step, parts, tasks);
  tasks.run(Stage::analyze, split_.part_count,
            [&](int i) { parts_[i].rebind(step, split_, i, tasks.memory().limit_bytes()); });
  allocate(tasks);
  return true;
}

bool SchurRowsKernel::factor(const RowWeights& weights, ParallelTasks& tasks, const RowWork& before) {
  run_work(before, *step_, tasks);
  assemble(weights, tasks);
  if (!factor_parts(tasks)) return false;
  form_interface(tasks);
  const bool succeeded = interface_.factor(tasks);
  kept_.end(succeeded, weights);
  return succeeded;
}

void SchurRowsKernel::assemble(const RowWeights& weights, ParallelTasks& tasks) {
  StageTimer timer(tasks.clock(), Stage::assemble);
  rows_.set(step_->problem(), weights);
  if (!weights.blocks.empty())
    tasks.run_over(step_->group_chunks(), [&](const Chunk& groups) { rows_.turn(step_->rows_of(groups)); });
  const bool all = kept_.begin(weights);
  tasks.run(split_.part_count, [&](int i) { parts_[i].assemble(rows_, all, kept_); });
}

// False when a pivot is not positive.
bool SchurRowsKernel::factor_parts(ParallelTasks& tasks) {
  tasks.run(Stage::factor_local, split_.part_count, [&](int i) { parts_[i].factor(); });
  return std::ranges::all_of(std::span(parts_).first(split_.part_count), &SchurPart::is_factored);
}

void SchurRowsKernel::form_interface(ParallelTasks& tasks) {
  StageTimer timer(tasks.clock(), Stage::form_interface);
  number_active_rows();
  tasks.run(split_.part_count, [&](int i) { parts_[i].form_complement(rows_, row_of_cut_); });
  interface_.resize(static_cast<int>(interface_rows_.size()));
  tasks.run(interface_.panel_count(), [&](int p) { gather_panel(p); });
}

void SchurRowsKernel::number_active_rows() {
  interface_rows_.clear();
  for (std::size_t c = 0; c < split_.cut_rows.size(); ++c) {
    const bool active = rows_.d()[split_.cut_rows[c]] > 0;
    row_of_cut_[c] = active ? static_cast<int>(interface_rows_.size()) : -1;
    if (active) interface_rows_.push_back(split_.cut_rows[c]);
  }
}

// One row panel of S: each row from the two parts that meet at it, in the order of the parts.
void SchurRowsKernel::gather_panel(int p) {
  double* entries = interface_.begin_panel(p);
  const int first = kPanelRows * p, end = std::min(interface_.size(), first + kPanelRows);
  for (int i = 0; i < split_.part_count; ++i) gather_part(parts_[i], first, end, entries);
  for (int row = first; row < end; ++row)
    entries[row - first + static_cast<long>(kPanelRows) * row] += 1 / rows_.d()[interface_rows_[row]];
}

// Column by column, as they lie in memory.
void SchurRowsKernel::gather_part(const SchurPart& part, int first, int end, double* entries) const {
  const std::span<const int> row_of = part.interface_rows(), sorted = part.by_interface_row();
  const auto lies_before = [&](int row) {
    return std::ranges::lower_bound(sorted, row, {}, [&](int k) { return row_of[k]; }) - sorted.begin();
  };
  const auto begin = lies_before(first), behind = lies_before(end);
  if (begin == behind) return;
  for (const int l : sorted.first(behind)) {
    double* column = entries + static_cast<long>(kPanelRows) * row_of[l] - first;
    for (const int k : sorted.subspan(begin, behind - begin))
      if (row_of[k] >= row_of[l]) column[row_of[k]] -= part.minus_gram(k, l);
  }
}

// S lambda_c = f_c - sum_i J_ci H_i^-1 g_i
void SchurRowsKernel::solve_interface(std::span<const double> f_r, std::span<double> dlambda) {
  lambda_.resize(interface_rows_.size());
  for (std::size_t c = 0; c < lambda_.size(); ++c) lambda_[c] = f_r[interface_rows_[c]];
  for (int i = 0; i < split_.part_count; ++i) {
    const std::span<const int> rows = parts_[i].interface_rows();
    for (std::size_t k = 0; k < rows.size(); ++k) lambda_[rows[k]] += parts_[i].coupling()[k];
  }
  interface_.solve(lambda_);
  for (std::size_t c = 0; c < split_.cut_rows.size(); ++c)
    dlambda[split_.cut_rows[c]] = row_of_cut_[c] < 0 ? 0.0 : lambda_[row_of_cut_[c]];
}

void SchurRowsKernel::solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
                            std::span<double> dlambda, ParallelTasks& tasks, const RowsAround& around) {
  StageTimer timer(tasks.clock(), Stage::solve);
  run_work(around.before, *step_, tasks);
  tasks.run(split_.part_count, [&](int i) { parts_[i].reduce(rows_, f_v, f_r); });
  solve_interface(f_r, dlambda);
  tasks.run(split_.part_count, [&](int i) { parts_[i].expand(rows_, lambda_, f_r, dv, dlambda); });
  run_work(around.after, *step_, tasks);
}

double SchurRowsKernel::local_mflop() const {
  double flops = 0;
  for (int i = 0; i < split_.part_count; ++i) flops += parts_[i].factor_flops();
  return flops * 1e-6;
}

double SchurRowsKernel::done_mflop() const {
  double flops = 0;
  for (int i = 0; i < split_.part_count; ++i) flops += parts_[i].done_flops();
  return flops * 1e-6 + interface_.mflop();
}

}  // namespace

std::unique_ptr<Kernel> make_schur_rows_kernel(const Settings&) {
  return std::make_unique<SchurRowsKernel>();
}

}  // namespace cleave
