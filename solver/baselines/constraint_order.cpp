#include "solver/baselines/constraint_order.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

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
  if (kind_ == OrderKind::random) shuffle(constraints_, dice_);
  return constraints_;
}

void ConstraintOrder::list_constraints(const PreparedStep& step) {
  const std::vector<int>& constraint = step.problem().row_constraint;
  constraints_.clear();
  first_of_group_.clear();
  for (const RowGroup& g : step.groups()) {
    first_of_group_.push_back(static_cast<int>(constraints_.size()));
    for (int r = g.first_row; r < g.first_row + g.row_count; ++r) {
      if (r == g.first_row || constraint[r] != constraint[r - 1])
        constraints_.push_back({g.body_a, g.body_b, r, 0});
      ++constraints_.back().row_count;
    }
  }
  first_of_group_.push_back(static_cast<int>(constraints_.size()));
}

// Breadth first over bodies: each is of the least level of its constraints.
void ConstraintOrder::measure_levels(const PreparedStep& step) {
  level_of_body_.assign(step.body_count(), kUnreached);
  level_.assign(constraints_.size(), kUnreached);
  reached_.clear();
  for (std::size_t i = 0; i < constraints_.size(); ++i)
    if (starts(step.problem(), constraints_[i])) reach(static_cast<int>(i), 0);
  for (std::size_t next = 0; next < reached_.size(); ++next) {
    const int body = reached_[next];
    for (const int side : step.sides_of_body(body)) {
      for (int i = first_of_group_[side / 2]; i < first_of_group_[side / 2 + 1]; ++i)
        reach(i, level_of_body_[body] + 1);
    }
  }
}

// The constraint and its bodies, where nothing has reached them before.
void ConstraintOrder::reach(int constraint, int level) {
  if (level_[constraint] != kUnreached) return;
  level_[constraint] = level;
  for (const int body : {constraints_[constraint].body_a, constraints_[constraint].body_b}) {
    if (body < 0 || level_of_body_[body] != kUnreached) continue;
    level_of_body_[body] = level;
    reached_.push_back(body);
  }
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
