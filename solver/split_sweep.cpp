#include "solver/split_sweep.h"

#include <algorithm>
#include <cassert>

#include "solver/counting_sort.h"
#include "solver/gauss_seidel.h"
#include "solver/group_products.h"

namespace cleave {

void SplitSweep::bind(const PreparedStep& step, std::span<const int> domain_of_group, int domains) {
  assert(step.set().axes().empty() && domain_of_group.size() == step.groups().size());
  step_ = &step;
  sort_into_buckets(
      static_cast<int>(domain_of_group.size()), domains, [&](int g) { return domain_of_group[g]; },
      first_of_domain_, groups_);
  list_copies();
  split_diagonal();
  cut_tasks();
}

void SplitSweep::list_copies() {
  const std::span<const RowGroup> groups = step_->groups();
  const int domains = static_cast<int>(first_of_domain_.size()) - 1;
  body_of_copy_.clear();
  first_copy_.assign(1, 0);
  copy_a_.resize(groups.size());
  copy_b_.resize(groups.size());
  latest_copy_.assign(step_->body_count(), -1);
  for (int domain = 0; domain < domains; ++domain) {
    for (int i = first_of_domain_[domain]; i < first_of_domain_[domain + 1]; ++i) {
      const RowGroup& g = groups[groups_[i]];
      copy_a_[groups_[i]] = copy_of(g.body_a, domain);
      copy_b_[groups_[i]] = g.body_b < 0 ? -1 : copy_of(g.body_b, domain);
    }
    first_copy_.push_back(static_cast<int>(body_of_copy_.size()));
  }
  sort_into_buckets(
      static_cast<int>(body_of_copy_.size()), step_->body_count(), [this](int c) { return body_of_copy_[c]; },
      first_of_body_, copies_);
  u_.resize(6 * body_of_copy_.size());
}

// Domains come one after the other: a body's latest copy is of this domain or of an earlier one.
int SplitSweep::copy_of(int body, int domain) {
  if (latest_copy_[body] < first_copy_[domain]) {
    latest_copy_[body] = static_cast<int>(body_of_copy_.size());
    body_of_copy_.push_back(body);
  }
  return latest_copy_[body];
}

// What the copies add to the diagonal of whole bodies, so that it is that one's bytes where nothing is split.
void SplitSweep::split_diagonal() {
  inverse_diagonal_.assign(step_->diagonal().begin(), step_->diagonal().end());
  for (const RowGroup& g : step_->groups()) {
    for (int side = 0; side < 2; ++side) {
      const int body = side == 0 ? g.body_a : g.body_b;
      if (body < 0 || copies_of(body) == 1) continue;
      for (int r = g.first_row; r < g.first_row + g.row_count; ++r) {
        const long first = 12L * r + 6 * side;
        double whole = 0;
        for (long c = first; c < first + 6; ++c)
          whole += step_->problem().jacobian[c] * step_->mass_jacobian()[c];
        inverse_diagonal_[r] += (copies_of(body) - 1) * whole;
      }
    }
  }
  for (double& d : inverse_diagonal_) d = 1 / d;
}

// Small domains are put together, so that a task pays.
void SplitSweep::cut_tasks() {
  const auto rows_of = [&](int domain) {
    int rows = 0;
    for (int i = first_of_domain_[domain]; i < first_of_domain_[domain + 1]; ++i)
      rows += step_->groups()[groups_[i]].row_count;
    return rows;
  };
  cut_into_chunks(static_cast<int>(first_of_domain_.size()) - 1, kLeastChunkRows, rows_of, domain_chunks_);
}

void SplitSweep::run(std::span<double> impulse, std::span<double> v, ParallelTasks& tasks) {
  if (domain_chunks_.empty()) return;
  tasks.run_over<Chunk>(domain_chunks_, [&](const Chunk& chunk) {
    for (int domain = chunk.first; domain < chunk.last; ++domain) sweep_domain(domain, impulse, v);
  });
  tasks.run_over(step_->body_chunks(), [&](const Chunk& bodies) { average(bodies, v); });
}

void SplitSweep::sweep_domain(int domain, std::span<double> impulse, std::span<const double> v) {
  for (int c = first_copy_[domain]; c < first_copy_[domain + 1]; ++c)
    std::copy_n(v.data() + 6L * body_of_copy_[c], 6, u_.data() + 6L * c);
  for (int i = first_of_domain_[domain]; i < first_of_domain_[domain + 1]; ++i)
    sweep_group(groups_[i], impulse);
}

void SplitSweep::sweep_group(int group, std::span<double> impulse) {
  const RowGroup& g = step_->groups()[group];
  double* of_a = u_.data() + 6L * copy_a_[group];
  double* of_b = g.body_b < 0 ? nullptr : u_.data() + 6L * copy_b_[group];
  const double copies[2] = {double(copies_of(g.body_a)), g.body_b < 0 ? 1.0 : double(copies_of(g.body_b))};
  double both[12] = {};
  std::copy_n(of_a, 6, both);
  if (of_b != nullptr) std::copy_n(of_b, 6, both + 6);
  gauss_seidel_rows(
      *step_, g, LaneSlack{}, WithinBounds(step_->problem(), inverse_diagonal_),
      [&](int c, double change) { return copies[c / 6] * change; }, impulse, both);
  std::copy_n(both, 6, of_a);
  if (of_b != nullptr) std::copy_n(both + 6, 6, of_b);
}

void SplitSweep::average(const Chunk& bodies, std::span<double> v) const {
  for (int body = bodies.first; body < bodies.last; ++body) {
    if (copies_of(body) == 0) continue;
    double sum[6] = {};
    for (int i = first_of_body_[body]; i < first_of_body_[body + 1]; ++i)
      for (int c = 0; c < 6; ++c) sum[c] += u_[6L * copies_[i] + c];
    for (int c = 0; c < 6; ++c) v[6L * body + c] = sum[c] / copies_of(body);
  }
}

}  // namespace cleave
