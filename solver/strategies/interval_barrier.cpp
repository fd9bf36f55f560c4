#include "solver/strategies/interval_barrier.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cleave {
namespace {

constexpr int kLanes = 4;  // running values side by side, for vector instructions

}  // namespace

BarrierCourse join_courses(std::span<const BarrierCourse> ranges) {
  BarrierCourse course;
  for (const BarrierCourse& part : ranges) {
    course.largest_step = std::max(course.largest_step, part.largest_step);
    for (int power = 0; power < 3; ++power) course.product[power] += part.product[power];
  }
  course.largest_step = 1 / course.largest_step;
  return course;
}

void IntervalBarrier::add_pairs(SolveState& state, int r, double speed) {
  const StepProblem& problem = state.step->problem();
  const double d = state.step->diagonal()[r], w = state.slack[r];
  const double lower = problem.lower[r], upper = problem.upper[r], width = upper - lower;
  const double rounding = std::numeric_limits<double>::epsilon() * std::abs(lower);
  if (d * width <= constants_.fixed_width_m_per_s ||
      (std::isfinite(width) && width <= constants_.fixed_roundings * rounding)) {
    use_[r] = RowUse::fixed;
    state.impulse[r] = 0.5 * (lower + upper);
    return;
  }
  // The impulse itself moves inside, so that slacks start feasible even where the bounds are close together.
  const double margin = std::min(speed / d, constants_.inside_share * width);
  if (std::isfinite(lower)) state.impulse[r] = std::max(state.impulse[r], lower + margin);
  if (std::isfinite(upper)) state.impulse[r] = std::min(state.impulse[r], upper - margin);
  const auto add = [&](double sign, double bound) {
    if (!std::isfinite(bound)) return;
    pairs_.push_back({r, sign, bound});
    s_.push_back(sign * (state.impulse[r] - bound));
    z_.push_back(std::max(sign * w, 0.0) + speed);
  };
  add(1, lower);
  add(-1, upper);
}

// task(first, last, range) with the pairs of a range.
template <class Task>
void IntervalBarrier::run_over_pairs(SolveState& state, const Task& task) const {
  state.run_over_rows([&](int, int, int range) { task(pair_first_[range], pair_first_[range + 1], range); });
}

void IntervalBarrier::start(SolveState& state, std::span<const double> speed) {
  pairs_.clear(), s_.clear(), z_.clear();
  pair_first_.clear();
  use_.assign(speed.size(), RowUse::bounded);
  for (const FrictionCone& cone : state.step->set().cones())
    std::fill_n(use_.begin() + cone.first_row, cone.row_count, RowUse::of_cone);
  for (std::size_t r = 0; r < speed.size(); ++r) {
    if (r % state.rows_of_a_range() == 0) pair_first_.push_back(static_cast<int>(pairs_.size()));
    if (!is_of_cone(r)) add_pairs(state, static_cast<int>(r), speed[r]);
  }
  pair_first_.push_back(static_cast<int>(pairs_.size()));
  for (std::vector<double>* v : {&now_.ds, &now_.dz, &now_.c, &inverse_s_, &inverse_z_, &gap_}) {
    v->assign(pairs_.size(), 0.0);
  }
}

void IntervalBarrier::weigh(SolveState& state, std::span<double> weight) {
  state.run_over_rows([&](int first, int last, int range) {
    for (int k = pair_first_[range]; k < pair_first_[range + 1]; ++k) {
      const auto [row, sign, bound] = pairs_[k];
      inverse_s_[k] = 1 / s_[k];
      inverse_z_[k] = 1 / z_[k];
      gap_[k] = sign * (state.impulse[row] - bound) - s_[k];
      weight[row] += z_[k] * inverse_s_[k];
    }
    for (int r = first; r < last; ++r) weight[r] = is_fixed(r) ? 0.0 : 1 / weight[r];
  });
}

void IntervalBarrier::aim(SolveState& state, double product, bool second_order) {
  const double share = second_order ? 1.0 : 0.0;
  run_over_pairs(state, [&](int first, int last, int) {
    for (int k = first; k < last; ++k) now_.c[k] = product - s_[k] * z_[k] - share * now_.ds[k] * now_.dz[k];
  });
}

void IntervalBarrier::right_hand_side(SolveState& state) const {
  state.run_over_rows([&](int first, int last, int range) {
    for (int r = first; r < last; ++r) state.f_r[r] = is_fixed(r) ? 0.0 : -state.slack[r];
    for (int k = pair_first_[range]; k < pair_first_[range + 1]; ++k) {
      state.f_r[pairs_[k].row] += pairs_[k].sign * (z_[k] + (now_.c[k] - z_[k] * gap_[k]) * inverse_s_[k]);
    }
  });
}

void IntervalBarrier::follow_range(int first, int last, std::span<const double> dlambda,
                                   BarrierCourse& course) {
  for (int k = first; k < last; ++k) now_.ds[k] = pairs_[k].sign * dlambda[pairs_[k].row] + gap_[k];
  for (int k = first; k < last; ++k) now_.dz[k] = (now_.c[k] - z_[k] * now_.ds[k]) * inverse_s_[k];
  double fastest[kLanes], sum[3][kLanes] = {};
  std::fill(fastest, fastest + kLanes, 1.0);
  const auto visit = [&](int k, int lane) {
    const double s = s_[k], z = z_[k], ds = now_.ds[k], dz = now_.dz[k];
    const double fall = std::max(-ds * inverse_s_[k], -dz * inverse_z_[k]);
    fastest[lane] = fastest[lane] < fall ? fall : fastest[lane];
    sum[0][lane] += s * z;
    sum[1][lane] += s * dz + z * ds;
    sum[2][lane] += ds * dz;
  };
  const int whole = first + (last - first) / kLanes * kLanes;
  for (int k = first; k < whole; k += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) visit(k + lane, lane);
  }
  for (int k = whole; k < last; ++k) visit(k, 0);
  course.largest_step = *std::max_element(fastest, fastest + kLanes);
  for (int power = 0; power < 3; ++power)
    course.product[power] = std::accumulate(sum[power], sum[power] + kLanes, 0.0);
}

BarrierCourse IntervalBarrier::follow(SolveState& state) {
  courses_.assign(state.range_count(), BarrierCourse{});
  run_over_pairs(state, [&](int first, int last, int range) {
    follow_range(first, last, state.dlambda, courses_[range]);
  });
  return join_courses(courses_);
}

void IntervalBarrier::correct(SolveState& state, double trial, double low, double high) {
  run_over_pairs(state, [&](int first, int last, int) {
    for (int k = first; k < last; ++k) {
      const double product = (s_[k] + trial * now_.ds[k]) * (z_[k] + trial * now_.dz[k]);
      if (product < low) now_.c[k] += low - product;
      if (product > high) now_.c[k] += std::max(high - product, -high);
    }
  });
}

void IntervalBarrier::advance(SolveState& state, double step) {
  state.run_over_rows([&](int first, int last, int range) {
    for (int r = first; r < last; ++r) {
      if (!is_fixed(r)) state.impulse[r] += step * state.dlambda[r];
    }
    for (int k = pair_first_[range]; k < pair_first_[range + 1]; ++k) {
      s_[k] += step * now_.ds[k];
      z_[k] += step * now_.dz[k];
    }
  });
}

double IntervalBarrier::error(SolveState& state, std::span<double> row_error) {
  const std::span<const double> d = state.step->diagonal();
  worst_.assign(state.range_count(), 0.0);
  state.run_over_rows([&](int first, int last, int range) {
    std::copy(state.slack.begin() + first, state.slack.begin() + last, row_error.begin() + first);
    for (int k = pair_first_[range]; k < pair_first_[range + 1]; ++k) {
      worst_[range] = std::max(worst_[range], std::min(d[pairs_[k].row] * s_[k], z_[k]));
      row_error[pairs_[k].row] -= pairs_[k].sign * z_[k];
    }
  });
  return worst_.empty() ? 0.0 : std::ranges::max(worst_);
}

void IntervalBarrier::read_active_set(SolveState& state) const {
  for (std::size_t r = 0; r < use_.size(); ++r) {
    state.state[r] = is_fixed(r) ? RowState::lower : RowState::free;
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const auto [r, sign, bound] = pairs_[k];
    if (state.step->diagonal()[r] * s_[k] < z_[k]) {
      state.state[r] = sign > 0 ? RowState::lower : RowState::upper;
    }
  }
}

}  // namespace cleave
