#include "solver/baselines/constraint_order.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace cleave {
namespace {

constexpr int kUnreached = std::numeric_limits<int>::max();

bool starts(const StepProblem& problem, const RowGroup& constraint) {
  return constraint.body_b < 0 || problem.row_kind[constraint.first_row] == RowKind::bilateral;
}

}  // namespace

void ConstraintOrder::begin(const PreparedStep& step) {
  if (kind_ == OrderKind::natural) return;
  dice_ = Dice(seed_);
  list_constraints(step);
  if (kind_ == OrderKind::random) return;
  if (kind_ == OrderKind::propagation) measure_levels(step);
  sort(step);
}

std::span<const RowGroup> ConstraintOrder::next(const PreparedStep& step) {
  if (kind_ == OrderKind::natural) return step.groups();
  if (kind_ == OrderKind::random) {
    for (std::size_t last = constraints_.size(); last > 1; --last)
      std::swap(constraints_[last - 1], constraints_[dice_.below(last)]);
  }
  return constraints_;
}

void ConstraintOrder::list_constraints(const PreparedStep& step) {
  const std::vector<int>& constraint = step.problem().row_constraint;
  constraints_.clear();
  for (const RowGroup& g : step.groups()) {
    for (int r = g.first_row; r < g.first_row + g.row_count; ++r) {
      if (r == g.first_row || constraint[r] != constraint[r - 1])
        constraints_.push_back({g.body_a, g.body_b, r, 0});
      ++constraints_.back().row_count;
    }
  }
}

// Breadth first, by passes over all constraints: there are as many as levels.
void ConstraintOrder::measure_levels(const PreparedStep& step) {
  level_of_body_.assign(step.body_count(), kUnreached);
  level_.assign(constraints_.size(), kUnreached);
  for (std::size_t i = 0; i < constraints_.size(); ++i)
    if (starts(step.problem(), constraints_[i])) level_[i] = 0;
  for (int level = 0; reach(level) > 0; ++level) {
  }
}

// Bodies of constraints of the level, then the constraints that these reach. How many constraints those are.
int ConstraintOrder::reach(int level) {
  const auto reach_body = [&](int body) {
    if (body >= 0) level_of_body_[body] = std::min(level_of_body_[body], level);
  };
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    if (level_[i] != level) continue;
    reach_body(constraints_[i].body_a);
    reach_body(constraints_[i].body_b);
  }
  int reached = 0;
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    const auto [a, b] = std::pair(constraints_[i].body_a, constraints_[i].body_b);
    if (level_[i] != kUnreached) continue;
    if (level_of_body_[a] != level && (b < 0 || level_of_body_[b] != level)) continue;
    level_[i] = level + 1;
    ++reached;
  }
  return reached;
}

void ConstraintOrder::sort(const PreparedStep& step) {
  order_.resize(constraints_.size());
  std::iota(order_.begin(), order_.end(), 0);
  const auto key = [&](int i) {
    const bool by_height = kind_ == OrderKind::height;
    const double height = step.problem().contact_point[3 * constraints_[i].first_row + 2];
    return std::tuple(by_height ? height : 0, by_height ? 0 : level_[i], i);
  };
  std::ranges::sort(order_, {}, key);
  unsorted_.assign(constraints_.begin(), constraints_.end());
  for (std::size_t i = 0; i < order_.size(); ++i) constraints_[i] = unsorted_[order_[i]];
}

}  // namespace cleave
