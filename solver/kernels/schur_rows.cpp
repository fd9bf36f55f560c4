// Kernel `schur-rows`: the parallel solver of the paper. Bodies are split into parts; the rows at the cut are
// the interface. With interior rows only in H_i = M_i + J_i^T D_i J_i (factored in parallel, one task a part)
// and over the cut rows with D_c > 0
//
//     S lambda_c = f_c - sum_i J_ci H_i^-1 g_i,     S = D_c^-1 + sum_i J_ci H_i^-1 J_ci^T      (dense)
//     dv_i = H_i^-1 (g_i + J_ci^T lambda_c),        g_i = f_v,i + J_i^T D_i f_i
//
// Source: Peiret, Andrews, Koevecses, Kry, Teichmann, "Schur complement-based substructuring of stiff
// multibody systems with contact", ACM TOG 2019; Liu and Andrews 2022, section 2. With H_i = L_i L_i^T each
// part keeps Y_i = L_i^-1 J_ci^T, so that J_ci H_i^-1 J_ci^T = Y_i^T Y_i and one half of every later solve is
// a product with Y_i. On the rows of a 3x3 block of D, J is J' along its basis (row_weights.h).
#include <algorithm>
#include <array>
#include <vector>

#include "solver/block_matrix.h"
#include "solver/group_products.h"
#include "solver/interface_split.h"
#include "solver/kernels/kernel.h"
#include "solver/linear/dense_block.h"
#include "solver/linear/dense_cholesky.h"
#include "solver/linear/dense_panel.h"

namespace cleave {
namespace {

int round_up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

// An array of zeros whose old values are of no interest.
void zeros(std::vector<double>& array, std::size_t size) {
  free_if_short(array, size);
  array.assign(size, 0.0);
}

// Everything one part owns; its tasks write nothing else.
struct Part {
  BlockMatrix matrix;
  std::vector<int> order;          // entries of PartRows::cut_rows by supernode of their body
  std::vector<int> active;         // of these, the entries with D > 0, in the same order
  std::vector<int> interface_row;  // their rows of S
  std::vector<int> begin;          // first right-hand side of each supernode, then their number
  std::vector<int> first, last;    // range of right-hand sides that are non-zero at each supernode
  std::vector<double> y;           // Y^T: (ld, 6 bodies), right-hand sides run fastest
  std::vector<double> minus_gram;  // -Y^T Y (ld, ld), lower triangle
  std::vector<double> velocity;    // L^-1 g, later dv, by position
  std::vector<double> coupling;    // -Y^T L^-1 g (ld), later -lambda_c
  std::vector<double> by_body;
  int ld = 0;
  bool analyzed = false, factored = false;
};

class SchurRowsKernel : public Kernel {
 public:
  void analyze(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) override;
  bool rebind(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) override;
  bool factor(const RowWeights& weights, ParallelTasks& tasks) override;
  void solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
             std::span<double> dlambda, ParallelTasks& tasks) override;
  int interface_unknowns() const override { return static_cast<int>(split_.cut_rows.size()); }
  double local_mflop() const override;
  double interface_mflop() const override { return interface_.mflop(); }

 private:
  void split(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks);
  void count_interface(MemoryCount& memory) const;
  void request_memory(ParallelTasks& tasks);
  void analyze_part(int part, std::uint64_t limit_bytes);
  void order_cut_rows(int part);
  void number_active_rows();
  void choose_active(int part);
  void form_complement(int part);
  void gather_panel(int p);
  void reduce(int part, std::span<const double> f_v, std::span<const double> f_r);
  void expand(int part, std::span<const double> f_r, std::span<double> dv, std::span<double> dlambda);

  const PreparedStep* step_ = nullptr;
  WeightedRows rows_;
  InterfaceSplit split_;
  std::vector<Part> parts_;
  std::vector<int> interface_row_;               // (cut rows) row of S, -1 where D = 0
  std::vector<int> active_rows_;                 // (size of S) problem row
  std::vector<std::array<int, 2>> row_part_;     // (size of S) the two parts of a row,
  std::vector<std::array<int, 2>> row_in_part_;  // and its place among their right-hand sides
  DenseCholesky interface_;
  std::vector<double> lambda_;
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
  interface_row_.resize(split_.cut_rows.size());
}

// With every cut row in the interface.
void SchurRowsKernel::count_interface(MemoryCount& memory) const {
  const std::size_t cut_rows = split_.cut_rows.size();
  DenseCholesky::count(static_cast<int>(cut_rows), memory);
  memory.add<double>(cut_rows);  // lambda
  memory.add<int>(6, cut_rows);  // where each row is
  memory.add_grown(split_.local_of_body, split_.cut_groups, split_.cut_rows);
  if (step_->set().has_blocks()) memory.add<double>(12, step_->row_count());
  for (int i = 0; i < split_.part_count; ++i) {
    const PartRows& rows = split_.parts[i];
    memory.add_grown(rows.bodies, rows.groups, rows.cut_rows, rows.cut_side);
    const std::uint64_t sides = round_up(static_cast<int>(rows.cut_rows.size()), 6);
    memory.add<double>(6 * sides, rows.bodies.size());  // Y
    memory.add<double>(sides, sides);                   // its Gram matrix
    memory.add<double>(sides);                          // coupling
    memory.add<int>(5, sides);                          // order, and twice what is active and where
    memory.add<double>(12, rows.bodies.size());         // velocity, by position and by body
    memory.add<int>(3, rows.bodies.size() + 1);         // at most a supernode a body
  }
}

// With the parts, once they are analysed.
void SchurRowsKernel::request_memory(ParallelTasks& tasks) {
  MemoryCount memory;
  count_interface(memory);
  memory.add_grown(parts_);
  bool counted_all = true;
  for (int i = 0; i < split_.part_count; ++i) {
    parts_[i].matrix.count(memory);
    counted_all &= parts_[i].analyzed;
  }
  tasks.memory().request(memory, counted_all);
}

void SchurRowsKernel::analyze(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) {
  split(step, parts, tasks);
  tasks.run(Stage::analyze, split_.part_count, [&](int i) { analyze_part(i, tasks.memory().limit_bytes()); });
  request_memory(tasks);
  tasks.run(Stage::analyze, split_.part_count, [&](int i) { parts_[i].matrix.allocate(); });
}

void SchurRowsKernel::analyze_part(int i, std::uint64_t limit_bytes) {
  const PartRows& rows = split_.parts[i];
  Part& part = parts_[i];
  part.analyzed = part.matrix.analyze(*step_, rows.bodies, split_.local_of_body, rows.groups, {}, 1,
                                      BlockMatrix::most_blocks(limit_bytes));
  if (part.analyzed) order_cut_rows(i);
}

// Every part decides for itself.
bool SchurRowsKernel::rebind(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) {
  split(step, parts, tasks);
  tasks.run(Stage::analyze, split_.part_count, [&](int i) {
    if (parts_[i].matrix.rebind(step, split_.local_of_body, split_.parts[i].groups)) {
      order_cut_rows(i);
    } else {
      analyze_part(i, tasks.memory().limit_bytes());
    }
  });
  request_memory(tasks);
  tasks.run(Stage::analyze, split_.part_count, [&](int i) { parts_[i].matrix.allocate(); });
  return true;
}

void SchurRowsKernel::order_cut_rows(int i) {
  Part& part = parts_[i];
  const PartRows& rows = split_.parts[i];
  const BlockSymbolic& symbolic = part.matrix.cholesky().symbolic();
  const auto supernode = [&](int entry) {
    const int body =
        step_->problem().row_body[2 * split_.cut_rows[rows.cut_rows[entry]] + rows.cut_side[entry]];
    return symbolic.supernode_at_position()[symbolic.position_of_node()[split_.local_of_body[body]]];
  };
  part.order.resize(rows.cut_rows.size());
  for (std::size_t k = 0; k < part.order.size(); ++k) part.order[k] = static_cast<int>(k);
  std::sort(part.order.begin(), part.order.end(), [&](int x, int y) {
    const int sx = supernode(x), sy = supernode(y);
    return sx != sy ? sx < sy : x < y;
  });
}

void SchurRowsKernel::number_active_rows() {
  active_rows_.clear();
  for (std::size_t c = 0; c < split_.cut_rows.size(); ++c) {
    const bool active = rows_.d()[split_.cut_rows[c]] > 0;
    interface_row_[c] = active ? static_cast<int>(active_rows_.size()) : -1;
    if (active) active_rows_.push_back(split_.cut_rows[c]);
  }
  row_part_.assign(active_rows_.size(), {-1, -1});
  row_in_part_.assign(active_rows_.size(), {-1, -1});
}

// Right-hand sides sorted by supernode: those that reach supernode s come from its subtree, a contiguous
// range.
void SchurRowsKernel::choose_active(int i) {
  Part& part = parts_[i];
  const PartRows& rows = split_.parts[i];
  const BlockSymbolic& symbolic = part.matrix.cholesky().symbolic();
  const int supernodes = static_cast<int>(symbolic.supernodes().size());
  part.active.clear();
  part.interface_row.clear();
  std::vector<int>& begin = part.begin;
  begin.assign(supernodes + 1, 0);
  for (int entry : part.order) {
    const int cut = rows.cut_rows[entry];
    if (interface_row_[cut] < 0) continue;
    const int body = step_->problem().row_body[2 * split_.cut_rows[cut] + rows.cut_side[entry]];
    ++begin[symbolic.supernode_at_position()[symbolic.position_of_node()[split_.local_of_body[body]]] + 1];
    part.active.push_back(entry);
    part.interface_row.push_back(interface_row_[cut]);
  }
  for (int s = 0; s < supernodes; ++s) begin[s + 1] += begin[s];
  part.ld = round_up(static_cast<int>(part.active.size()), 6);
  part.first.resize(supernodes);
  part.last.resize(supernodes);
  for (int s = 0; s < supernodes; ++s) {
    const int subtree = begin[symbolic.supernodes()[s].first_descendant];
    const bool empty = subtree == begin[s + 1];
    part.first[s] = subtree / 6 * 6;
    part.last[s] = empty ? part.first[s] : std::min(part.ld, round_up(begin[s + 1], 6));
  }
}

void SchurRowsKernel::form_complement(int i) {
  Part& part = parts_[i];
  const PartRows& rows = split_.parts[i];
  const BlockSymbolic& symbolic = part.matrix.cholesky().symbolic();
  zeros(part.y, static_cast<std::size_t>(part.ld) * 6 * rows.bodies.size());
  for (std::size_t k = 0; k < part.active.size(); ++k) {
    const int row = split_.cut_rows[rows.cut_rows[part.active[k]]], side = rows.cut_side[part.active[k]];
    const int body = step_->problem().row_body[2 * row + side];
    const long position = symbolic.position_of_node()[split_.local_of_body[body]];
    const double* j = rows_.jacobian() + 12L * row + 6 * side;
    for (int c = 0; c < 6; ++c) part.y[k + (6 * position + c) * part.ld] = j[c];
  }
  part.matrix.cholesky().forward_many(part.y.data(), part.ld, part.first, part.last);
  zeros(part.minus_gram, static_cast<std::size_t>(part.ld) * part.ld);
  for (std::size_t s = 0; s < symbolic.supernodes().size(); ++s) {
    const Supernode& node = symbolic.supernodes()[s];
    const double* columns = part.y.data() + 6L * node.first_position * part.ld;
    for (int k = part.first[s]; k < part.last[s]; k += 6) {
      subtract_product(part.last[s] - k, 6 * node.width, columns + k, part.ld, columns + k, part.ld,
                       part.minus_gram.data() + k + static_cast<long>(k) * part.ld, part.ld);
    }
  }
}

// One row panel of S: each row from the two parts that meet at it, in the order of the parts.
void SchurRowsKernel::gather_panel(int p) {
  double* entries = interface_.begin_panel(p);
  const int first = kPanelRows * p, end = std::min(interface_.size(), first + kPanelRows);
  for (int row = first; row < end; ++row) {
    double* s = entries + (row - first);
    for (int side = 0; side < 2; ++side) {
      const Part& part = parts_[row_part_[row][side]];
      const int k = row_in_part_[row][side];
      for (std::size_t l = 0; l < part.interface_row.size(); ++l) {
        const int column = part.interface_row[l];
        const long low = std::max<long>(k, l), high = std::min<long>(k, l);
        if (column <= row) s[static_cast<long>(kPanelRows) * column] -= part.minus_gram[low + high * part.ld];
      }
    }
    s[static_cast<long>(kPanelRows) * row] += 1 / rows_.d()[active_rows_[row]];
  }
}

bool SchurRowsKernel::factor(const RowWeights& weights, ParallelTasks& tasks) {
  const int count = split_.part_count;
  {
    StageTimer timer(tasks.clock(), Stage::assemble);
    rows_.set(step_->problem(), weights);
    if (!weights.blocks.empty())
      tasks.run_over(step_->group_chunks(), [&](const Chunk& groups) { rows_.turn(step_->rows_of(groups)); });
  }
  tasks.run(Stage::assemble, count, [&](int i) { parts_[i].matrix.assemble(rows_); });
  tasks.run(Stage::factor_local, count, [&](int i) { parts_[i].factored = parts_[i].matrix.factor(); });
  for (int i = 0; i < count; ++i) {
    if (!parts_[i].factored) return false;
  }
  {
    StageTimer timer(tasks.clock(), Stage::form_interface);
    number_active_rows();
  }
  tasks.run(Stage::form_interface, count, [&](int i) {
    choose_active(i);
    form_complement(i);
  });
  {
    StageTimer timer(tasks.clock(), Stage::form_interface);
    for (int i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < parts_[i].interface_row.size(); ++k) {
        const int row = parts_[i].interface_row[k], side = row_part_[row][0] < 0 ? 0 : 1;
        row_part_[row][side] = i;
        row_in_part_[row][side] = static_cast<int>(k);
      }
    }
    interface_.resize(static_cast<int>(active_rows_.size()));
  }
  tasks.run(Stage::form_interface, interface_.panel_count(), [&](int p) { gather_panel(p); });
  return interface_.factor(tasks);
}

// g_i, then L_i^-1 g_i and its coupling Y_i^T L_i^-1 g_i to the interface.
void SchurRowsKernel::reduce(int i, std::span<const double> f_v, std::span<const double> f_r) {
  Part& part = parts_[i];
  const PartRows& rows = split_.parts[i];
  const std::span<const double> d = rows_.d();
  part.by_body.resize(6 * rows.bodies.size());
  for (std::size_t k = 0; k < rows.bodies.size(); ++k) {
    std::copy_n(f_v.data() + 6 * rows.bodies[k], 6, part.by_body.data() + 6 * k);
  }
  for (int g : rows.groups) {
    const RowGroup& group = step_->groups()[g];
    double sum[12];
    sum_rows(
        group, rows_.jacobian(), [&](int r) { return d[r] * f_r[r]; }, sum);
    double* a = part.by_body.data() + 6 * split_.local_of_body[group.body_a];
    for (int c = 0; c < 6; ++c) a[c] += sum[c];
    if (group.body_b < 0) continue;
    double* b = part.by_body.data() + 6 * split_.local_of_body[group.body_b];
    for (int c = 0; c < 6; ++c) b[c] += sum[6 + c];
  }
  part.matrix.cholesky().to_positions(part.by_body, part.velocity);
  part.matrix.cholesky().forward(part.velocity.data());
  part.coupling.assign(part.ld, 0.0);
  subtract_matrix_vector(part.ld, static_cast<int>(part.velocity.size()), part.y.data(), part.ld,
                         part.velocity.data(), part.coupling.data());
}

// dv_i = L_i^-T (L_i^-1 g_i + Y_i lambda_c), then the impulses of the interior rows.
void SchurRowsKernel::expand(int i, std::span<const double> f_r, std::span<double> dv,
                             std::span<double> dlambda) {
  Part& part = parts_[i];
  const PartRows& rows = split_.parts[i];
  const double *jacobian = rows_.jacobian(), *d = rows_.d().data();
  part.coupling.assign(part.ld, 0.0);
  for (std::size_t k = 0; k < part.interface_row.size(); ++k)
    part.coupling[k] = -lambda_[part.interface_row[k]];
  subtract_transpose_vector(part.ld, static_cast<int>(part.velocity.size()), part.y.data(), part.ld,
                            part.coupling.data(), part.velocity.data());
  part.matrix.cholesky().backward(part.velocity.data());
  part.matrix.cholesky().to_nodes(part.velocity, part.by_body);
  for (std::size_t k = 0; k < rows.bodies.size(); ++k) {
    std::copy_n(part.by_body.data() + 6 * k, 6, dv.data() + 6 * rows.bodies[k]);
  }
  for (int g : rows.groups) {
    const RowGroup& group = step_->groups()[g];
    for (int r = group.first_row; r < group.first_row + group.row_count; ++r) {
      const double* j = jacobian + 12L * r;
      double jv = 0;
      for (int c = 0; c < 6; ++c) jv += j[c] * dv[6 * group.body_a + c];
      for (int c = 0; c < 6 && group.body_b >= 0; ++c) jv += j[6 + c] * dv[6 * group.body_b + c];
      dlambda[r] = d[r] * (f_r[r] - jv);
    }
  }
}

void SchurRowsKernel::solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
                            std::span<double> dlambda, ParallelTasks& tasks) {
  tasks.run(Stage::solve, split_.part_count, [&](int i) { reduce(i, f_v, f_r); });
  {
    StageTimer timer(tasks.clock(), Stage::solve);
    lambda_.resize(active_rows_.size());
    for (std::size_t c = 0; c < active_rows_.size(); ++c) lambda_[c] = f_r[active_rows_[c]];
    for (int i = 0; i < split_.part_count; ++i) {
      const Part& part = parts_[i];
      for (std::size_t k = 0; k < part.interface_row.size(); ++k)
        lambda_[part.interface_row[k]] += part.coupling[k];
    }
    interface_.solve(lambda_);
    for (std::size_t c = 0; c < split_.cut_rows.size(); ++c) {
      dlambda[split_.cut_rows[c]] = interface_row_[c] < 0 ? 0.0 : lambda_[interface_row_[c]];
    }
  }
  tasks.run(Stage::solve, split_.part_count, [&](int i) { expand(i, f_r, dv, dlambda); });
}

double SchurRowsKernel::local_mflop() const {
  double sum = 0;
  for (int i = 0; i < split_.part_count; ++i) sum += parts_[i].matrix.cholesky().symbolic().factor_flops(0);
  return sum * 1e-6;
}

}  // namespace

std::unique_ptr<Kernel> make_schur_rows_kernel(const Settings&) {
  return std::make_unique<SchurRowsKernel>();
}

}  // namespace cleave
