#include "solver/strategies/interval_barrier.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cleave {
namespace {

constexpr std::size_t kLanes = 4;  // running values side by side, for vector instructions

}  // namespace

void IntervalBarrier::add_pairs(SolveState& state, int r, double speed) {
  const StepProblem& problem = state.step->problem();
  const double d = state.step->diagonal()[r], w = state.slack[r];
  const double lower = problem.lower[r], upper = problem.upper[r], width = upper - lower;
  const double rounding = std::numeric_limits<double>::epsilon() * std::abs(lower);
  fixed_[r] = d * width <= constants_.fixed_width_m_per_s ||
              (std::isfinite(width) && width <= constants_.fixed_roundings * rounding);
  if (fixed_[r]) {
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

void IntervalBarrier::start(SolveState& state, std::span<const double> speed) {
  pairs_.clear(), s_.clear(), z_.clear();
  fixed_.assign(speed.size(), false);
  for (std::size_t r = 0; r < speed.size(); ++r) add_pairs(state, static_cast<int>(r), speed[r]);
  for (std::vector<double>* v : {&now_.ds, &now_.dz, &now_.c, &inverse_s_, &inverse_z_, &gap_}) {
    v->assign(pairs_.size(), 0.0);
  }
}

void IntervalBarrier::weigh(const SolveState& state, std::span<double> weight) {
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const auto [row, sign, bound] = pairs_[k];
    inverse_s_[k] = 1 / s_[k];
    inverse_z_[k] = 1 / z_[k];
    gap_[k] = sign * (state.impulse[row] - bound) - s_[k];
    weight[row] += z_[k] * inverse_s_[k];
  }
  for (std::size_t r = 0; r < fixed_.size(); ++r) weight[r] = fixed_[r] ? 0.0 : 1 / weight[r];
}

void IntervalBarrier::aim(double product, bool second_order) {
  const double share = second_order ? 1.0 : 0.0;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    now_.c[k] = product - s_[k] * z_[k] - share * now_.ds[k] * now_.dz[k];
  }
}

void IntervalBarrier::right_hand_side(std::span<const double> slack, std::span<double> f_r) const {
  for (std::size_t r = 0; r < fixed_.size(); ++r) f_r[r] = fixed_[r] ? 0.0 : -slack[r];
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    f_r[pairs_[k].row] += pairs_[k].sign * (z_[k] + (now_.c[k] - z_[k] * gap_[k]) * inverse_s_[k]);
  }
}

void IntervalBarrier::follow(std::span<const double> dlambda) {
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    now_.ds[k] = pairs_[k].sign * dlambda[pairs_[k].row] + gap_[k];
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    now_.dz[k] = (now_.c[k] - z_[k] * now_.ds[k]) * inverse_s_[k];
  }
}

BarrierCourse IntervalBarrier::course() const {
  double fastest[kLanes], sum[3][kLanes] = {};
  std::fill(fastest, fastest + kLanes, 1.0);
  const auto visit = [&](std::size_t k, std::size_t lane) {
    const double s = s_[k], z = z_[k], ds = now_.ds[k], dz = now_.dz[k];
    const double fall = std::max(-ds * inverse_s_[k], -dz * inverse_z_[k]);
    fastest[lane] = fastest[lane] < fall ? fall : fastest[lane];
    sum[0][lane] += s * z;
    sum[1][lane] += s * dz + z * ds;
    sum[2][lane] += ds * dz;
  };
  const std::size_t whole = pairs_.size() / kLanes * kLanes;
  for (std::size_t k = 0; k < whole; k += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) visit(k + lane, lane);
  }
  for (std::size_t k = whole; k < pairs_.size(); ++k) visit(k, 0);
  BarrierCourse course;
  course.largest_step = 1 / *std::max_element(fastest, fastest + kLanes);
  for (int power = 0; power < 3; ++power) {
    course.product[power] = std::accumulate(sum[power], sum[power] + kLanes, 0.0);
  }
  return course;
}

void IntervalBarrier::correct(double trial, double low, double high) {
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const double product = (s_[k] + trial * now_.ds[k]) * (z_[k] + trial * now_.dz[k]);
    if (product < low) now_.c[k] += low - product;
    if (product > high) now_.c[k] += std::max(high - product, -high);
  }
}

void IntervalBarrier::advance(double step) {
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    s_[k] += step * now_.ds[k];
    z_[k] += step * now_.dz[k];
  }
}

double IntervalBarrier::error(std::span<const double> d, std::span<double> row_error) const {
  double worst = 0;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    worst = std::max(worst, std::min(d[pairs_[k].row] * s_[k], z_[k]));
    row_error[pairs_[k].row] -= pairs_[k].sign * z_[k];
  }
  return worst;
}

void IntervalBarrier::read_active_set(SolveState& state) const {
  for (std::size_t r = 0; r < fixed_.size(); ++r) {
    state.state[r] = fixed_[r] ? RowState::lower : RowState::free;
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const auto [r, sign, bound] = pairs_[k];
    if (state.step->diagonal()[r] * s_[k] < z_[k]) {
      state.state[r] = sign > 0 ? RowState::lower : RowState::upper;
    }
  }
}

}  // namespace cleave
