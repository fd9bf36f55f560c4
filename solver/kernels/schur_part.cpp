#include "solver/kernels/schur_part.h"

#include <numeric>

#include "harness/base/ceil_div.h"
#include "solver/group_products.h"
#include "solver/linear/dense_block.h"

namespace cleave {
namespace {

int round_up(int value, int multiple) { return ceil_div(value, multiple) * multiple; }

// An array of zeros whose old values are of no interest.
void zeros(std::vector<double>& array, std::size_t size) {
  free_if_short(array, size);
  array.assign(size, 0.0);
}

}  // namespace

void SchurPart::bind(const PreparedStep& step, const InterfaceSplit& split, int index) {
  step_ = &step;
  split_ = &split;
  index_ = index;
}

void SchurPart::analyze(const PreparedStep& step, const InterfaceSplit& split, int index,
                        std::uint64_t limit_bytes) {
  bind(step, split, index);
  analyzed_ = matrix_.analyze(step, part_rows().bodies, split.local_of_body, part_rows().groups, {}, 1,
                              BlockMatrix::most_blocks(limit_bytes));
  if (analyzed_) order_cut_rows();
}

void SchurPart::rebind(const PreparedStep& step, const InterfaceSplit& split, int index,
                       std::uint64_t limit_bytes) {
  bind(step, split, index);
  if (!matrix_.rebind(step, split.local_of_body, part_rows().groups))
    return analyze(step, split, index, limit_bytes);
  order_cut_rows();
}

void SchurPart::count_right_hand_sides(const PartRows& rows, MemoryCount& memory) {
  const std::uint64_t sides = round_up(static_cast<int>(rows.cut_rows.size()), 6);
  memory.add<double>(6 * sides, rows.bodies.size());  // Y
  memory.add<double>(sides, sides);                   // its Gram matrix
  memory.add<double>(sides);                          // coupling
  memory.add<int>(8, sides);                   // order, and twice what is active, was, where, and by its row
  memory.add<double>(12, rows.bodies.size());  // velocity, by position and by body
  memory.add<int>(3, rows.bodies.size() + 1);  // at most a supernode a body
}

void SchurPart::assemble(const WeightedRows& rows, bool all, KeptWeights& kept) {
  is_remade_ = all;
  for (const int g : part_rows().groups) is_remade_ |= kept.take(step_->groups()[g], rows.d());
  if (is_remade_) matrix_.assemble(rows);
}

// Of the body of a cut row that is in this part.
int SchurPart::position_of(int entry) const {
  const int body = step_->problem().row_body[2 * row_of(entry) + part_rows().cut_side[entry]];
  return matrix_.cholesky().symbolic().position_of_node()[split_->local_of_body[body]];
}

int SchurPart::supernode_of(int entry) const {
  return matrix_.cholesky().symbolic().supernode_at_position()[position_of(entry)];
}

void SchurPart::order_cut_rows() {
  order_.resize(part_rows().cut_rows.size());
  for (std::vector<int>* of_active : {&active_, &kept_active_}) of_active->reserve(order_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::ranges::sort(order_, [&](int x, int y) {
    const int sx = supernode_of(x), sy = supernode_of(y);
    return sx != sy ? sx < sy : x < y;
  });
}

void SchurPart::choose_active(std::span<const int> interface_row) {
  kept_active_.swap(active_);
  active_.clear();
  interface_row_.clear();
  begin_.assign(matrix_.cholesky().symbolic().supernodes().size() + 1, 0);
  for (const int entry : order_) {
    const int row = interface_row[part_rows().cut_rows[entry]];
    if (row < 0) continue;
    ++begin_[supernode_of(entry) + 1];
    active_.push_back(entry);
    interface_row_.push_back(row);
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  by_interface_row_.resize(active_.size());
  std::iota(by_interface_row_.begin(), by_interface_row_.end(), 0);
  std::ranges::sort(by_interface_row_, {}, [this](int k) { return interface_row_[k]; });
  ld_ = round_up(static_cast<int>(active_.size()), 6);
}

void SchurPart::find_ranges() {
  const auto supernodes = matrix_.cholesky().symbolic().supernodes();
  first_.resize(supernodes.size());
  last_.resize(supernodes.size());
  for (std::size_t s = 0; s < supernodes.size(); ++s) {
    const int subtree = begin_[supernodes[s].first_descendant];
    const bool empty = subtree == begin_[s + 1];
    first_[s] = subtree / 6 * 6;
    last_[s] = empty ? first_[s] : std::min(ld_, round_up(begin_[s + 1], 6));
  }
}

void SchurPart::set_right_hand_sides(const WeightedRows& rows) {
  zeros(y_, static_cast<std::size_t>(ld_) * 6 * part_rows().bodies.size());
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const double* j = rows.jacobian() + 12L * row_of(active_[k]) + 6 * part_rows().cut_side[active_[k]];
    double* column = y_.data() + k + 6L * position_of(active_[k]) * ld_;
    for (int c = 0; c < 6; ++c) column[static_cast<long>(c) * ld_] = j[c];
  }
}

void SchurPart::form_gram() {
  zeros(minus_gram_, static_cast<std::size_t>(ld_) * ld_);
  const auto supernodes = matrix_.cholesky().symbolic().supernodes();
  for (std::size_t s = 0; s < supernodes.size(); ++s) {
    const double* columns = y_.data() + 6L * supernodes[s].first_position * ld_;
    for (int k = first_[s]; k < last_[s]; k += 6) {
      subtract_product(last_[s] - k, 6 * supernodes[s].width, columns + k, ld_, columns + k, ld_,
                       minus_gram_.data() + k + static_cast<long>(k) * ld_, ld_);
    }
  }
}

void SchurPart::form_complement(const WeightedRows& rows, std::span<const int> interface_row) {
  choose_active(interface_row);
  if (!is_remade_ && active_ == kept_active_) return;
  find_ranges();
  set_right_hand_sides(rows);
  matrix_.cholesky().forward_many(y_.data(), ld_, first_, last_);
  form_gram();
}

// by_body += J^T D f_r
void SchurPart::add_impulses(const WeightedRows& rows, std::span<const double> f_r) {
  const std::span<const double> d = rows.d();
  for (const int g : part_rows().groups) {
    const RowGroup& group = step_->groups()[g];
    double sum[12];
    sum_rows(
        group, rows.jacobian(), [&](int r) { return d[r] * f_r[r]; }, sum);
    double* a = by_body_.data() + 6 * split_->local_of_body[group.body_a];
    for (int c = 0; c < 6; ++c) a[c] += sum[c];
    if (group.body_b < 0) continue;
    double* b = by_body_.data() + 6 * split_->local_of_body[group.body_b];
    for (int c = 0; c < 6; ++c) b[c] += sum[6 + c];
  }
}

void SchurPart::reduce(const WeightedRows& rows, std::span<const double> f_v, std::span<const double> f_r) {
  const std::vector<int>& bodies = part_rows().bodies;
  by_body_.resize(6 * bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k)
    std::copy_n(f_v.data() + 6 * bodies[k], 6, by_body_.data() + 6 * k);
  add_impulses(rows, f_r);
  matrix_.cholesky().to_positions(by_body_, velocity_);
  matrix_.cholesky().forward(velocity_.data());
  add_coupling();
}

// -Y^T velocity, by supernode, as Y is zero outside its range of right-hand sides.
void SchurPart::add_coupling() {
  coupling_.assign(ld_, 0.0);
  const auto supernodes = matrix_.cholesky().symbolic().supernodes();
  for (std::size_t s = 0; s < supernodes.size(); ++s) {
    const long column = 6L * supernodes[s].first_position;
    subtract_matrix_vector(last_[s] - first_[s], 6 * supernodes[s].width,
                           y_.data() + first_[s] + column * ld_, ld_, velocity_.data() + column,
                           coupling_.data() + first_[s]);
  }
}

// velocity -= Y coupling. Four sums a column run side by side over every fourth right-hand side: ranges begin
// and end where all four do, so that each has the terms of a product with all of Y.
void SchurPart::add_impulses_of_interface() {
  const auto supernodes = matrix_.cholesky().symbolic().supernodes();
  for (std::size_t s = 0; s < supernodes.size(); ++s) {
    if (last_[s] == first_[s]) continue;
    const int begin = first_[s] / 4 * 4, end = std::min(round_up(last_[s], 4), ld_);
    const long column = 6L * supernodes[s].first_position;
    subtract_transpose_vector(end - begin, 6 * supernodes[s].width, y_.data() + begin + column * ld_, ld_,
                              coupling_.data() + begin, velocity_.data() + column);
  }
}

// dlambda = D (f_r - J dv)
void SchurPart::find_impulses(const WeightedRows& rows, std::span<const double> f_r,
                              std::span<const double> dv, std::span<double> dlambda) const {
  for (const int g : part_rows().groups) {
    const RowGroup& group = step_->groups()[g];
    for (int r = group.first_row; r < group.first_row + group.row_count; ++r) {
      const double* j = rows.jacobian() + 12L * r;
      double jv = 0;
      for (int c = 0; c < 6; ++c) jv += j[c] * dv[6 * group.body_a + c];
      for (int c = 0; c < 6 && group.body_b >= 0; ++c) jv += j[6 + c] * dv[6 * group.body_b + c];
      dlambda[r] = rows.d()[r] * (f_r[r] - jv);
    }
  }
}

void SchurPart::expand(const WeightedRows& rows, std::span<const double> lambda, std::span<const double> f_r,
                       std::span<double> dv, std::span<double> dlambda) {
  coupling_.assign(ld_, 0.0);
  for (std::size_t k = 0; k < interface_row_.size(); ++k) coupling_[k] = -lambda[interface_row_[k]];
  add_impulses_of_interface();
  matrix_.cholesky().backward(velocity_.data());
  matrix_.cholesky().to_nodes(velocity_, by_body_);
  const std::vector<int>& bodies = part_rows().bodies;
  for (std::size_t k = 0; k < bodies.size(); ++k)
    std::copy_n(by_body_.data() + 6 * k, 6, dv.data() + 6 * bodies[k]);
  find_impulses(rows, f_r, dv, dlambda);
}

}  // namespace cleave
