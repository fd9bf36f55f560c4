#include "solver/strategies/interior_iterate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace cleave {
namespace {

constexpr std::size_t kLanes = 4;  // running values side by side, for vector instructions

}  // namespace

void InteriorIterate::add_pairs(SolveState& state, int r, double speed) {
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

// Impulses of the last step that are not nearly right cost more iterations than starting from none.
void InteriorIterate::choose_impulses(SolveState& state) {
  const double warm = state.residual();
  kept_impulse_ = state.impulse;
  for (std::size_t r = 0; r < state.impulse.size(); ++r) {
    state.impulse[r] = std::clamp(0.0, state.step->problem().lower[r], state.step->problem().upper[r]);
  }
  state.update_velocity();
  if (constants_.warm_share * state.residual() < warm) return;
  state.impulse = kept_impulse_;
  state.update_velocity();
}

// Every row starts with the same product s z, an energy: at a speed of sqrt(energy d), where light bodies
// have a large d and heavy ones a small one. The same speed everywhere would let the heavy rule the target.
void InteriorIterate::start(SolveState& state) {
  choose_impulses(state);
  const int m = state.step->row_count();
  pairs_.clear(), s_.clear(), z_.clear();
  fixed_.assign(m, false);
  double energy = 0, fastest = 0;
  for (int r = 0; r < m; ++r) {
    energy += state.slack[r] * state.slack[r] / state.step->diagonal()[r];
    fastest = std::max(fastest, std::abs(state.slack[r]));
  }
  energy *= constants_.start_energy / std::max(m, 1);
  for (int r = 0; r < m; ++r) {
    const double speed =
        std::min(std::sqrt(energy * state.step->diagonal()[r]), constants_.most_speed * fastest);
    add_pairs(state, r, std::max(constants_.least_speed_m_per_s, speed));
  }
  for (std::vector<double>* v : {&now_.ds, &now_.dz, &now_.c, &inverse_s_, &inverse_z_, &gap_}) {
    v->assign(pairs_.size(), 0.0);
  }
  state.update_velocity();
}

bool InteriorIterate::factor(SolveState& state, double delta) {
  const StepProblem& problem = state.step->problem();
  for (std::size_t r = 0; r < fixed_.size(); ++r) {
    state.weight[r] = std::max(problem.compliance[r], delta * state.step->diagonal()[r]);
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const auto [row, sign, bound] = pairs_[k];
    inverse_s_[k] = 1 / s_[k];
    inverse_z_[k] = 1 / z_[k];
    gap_[k] = sign * (state.impulse[row] - bound) - s_[k];
    state.weight[row] += z_[k] * inverse_s_[k];
  }
  for (std::size_t r = 0; r < fixed_.size(); ++r) state.weight[r] = fixed_[r] ? 0.0 : 1 / state.weight[r];
  return state.factor();
}

void InteriorIterate::find_direction(SolveState& state, Aim aim) {
  set_products(aim);
  solve(state);
}

void InteriorIterate::set_products(Aim aim) {
  const double now = mean_product(0);
  if (aim == Aim::affine) target_ = 0;
  if (aim == Aim::centre) target_ = constants_.centring * now;
  if (aim == Aim::mehrotra) {
    const double ratio = mean_product(largest_step_) / now;
    double share = 1;
    for (int power = 0; power < constants_.target_power; ++power) share *= ratio;
    target_ = share * now;
  }
  const double second_order = aim == Aim::mehrotra ? 1.0 : 0.0;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    now_.c[k] = target_ - s_[k] * z_[k] - second_order * now_.ds[k] * now_.dz[k];
  }
}

void InteriorIterate::set_right_hand_side(SolveState& state) {
  for (std::size_t r = 0; r < fixed_.size(); ++r) state.f_r[r] = fixed_[r] ? 0.0 : -state.slack[r];
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    state.f_r[pairs_[k].row] += pairs_[k].sign * (z_[k] + (now_.c[k] - z_[k] * gap_[k]) * inverse_s_[k]);
  }
}

void InteriorIterate::solve(SolveState& state) {
  set_right_hand_side(state);
  std::fill(state.f_v.begin(), state.f_v.end(), 0.0);
  state.solve();
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    now_.ds[k] = pairs_[k].sign * state.dlambda[pairs_[k].row] + gap_[k];
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    now_.dz[k] = (now_.c[k] - z_[k] * now_.ds[k]) * inverse_s_[k];
  }
  measure_direction();
}

double InteriorIterate::rounding(SolveState& state) {
  set_right_hand_side(state);
  change_.resize(state.velocity.size());
  row_error_.resize(fixed_.size());
  state.step->velocity(state.step->set().in_rows(state.dlambda, state.row_impulse), change_);
  for (std::size_t c = 0; c < change_.size(); ++c) change_[c] -= state.step->problem().free_velocity[c];
  state.step->jacobian_times(change_, row_error_);
  state.step->set().to_axes(row_error_);
  double worst = 0;
  for (std::size_t r = 0; r < fixed_.size(); ++r) {
    if (fixed_[r]) continue;
    worst = std::max(worst, std::abs(state.f_r[r] - row_error_[r] - state.dlambda[r] / state.weight[r]));
  }
  return worst;
}

void InteriorIterate::measure_direction() {
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
  largest_step_ = 1 / *std::max_element(fastest, fastest + kLanes);
  for (int power = 0; power < 3; ++power) sum_[power] = std::accumulate(sum[power], sum[power] + kLanes, 0.0);
}

double InteriorIterate::mean_product(double step) const {
  if (pairs_.empty()) return 0;
  return (sum_[0] + step * (sum_[1] + step * sum_[2])) / static_cast<double>(pairs_.size());
}

void InteriorIterate::correct_centrality(SolveState& state) {
  const double low = constants_.band * target_, high = target_ / constants_.band;
  for (int k = 0; k < constants_.corrections && largest_step_ < constants_.long_step; ++k) {
    const double step = largest_step_, trial = std::min(1.0, step + constants_.reach);
    now_.dlambda = state.dlambda;
    before_ = now_;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const double product = (s_[p] + trial * now_.ds[p]) * (z_[p] + trial * now_.dz[p]);
      if (product < low) now_.c[p] += low - product;
      if (product > high) now_.c[p] += std::max(high - product, -high);
    }
    solve(state);
    if (largest_step_ >= step + constants_.least_gain * (trial - step)) continue;
    std::swap(now_, before_);
    state.dlambda = now_.dlambda;
    measure_direction();
    return;
  }
}

void InteriorIterate::advance(SolveState& state, double step) {
  for (std::size_t r = 0; r < fixed_.size(); ++r) {
    if (!fixed_[r]) state.impulse[r] += step * state.dlambda[r];
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    s_[k] += step * now_.ds[k];
    z_[k] += step * now_.dz[k];
  }
  state.update_velocity();
}

double InteriorIterate::error(const SolveState& state) {
  double worst = 0;
  row_error_ = state.slack;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const double d = state.step->diagonal()[pairs_[k].row];
    worst = std::max(worst, std::min(d * s_[k], z_[k]));
    row_error_[pairs_[k].row] -= pairs_[k].sign * z_[k];
  }
  for (std::size_t r = 0; r < fixed_.size(); ++r) {
    if (!fixed_[r] && !(std::abs(row_error_[r]) <= worst)) worst = std::abs(row_error_[r]);
  }
  return worst;
}

void InteriorIterate::read_active_set(SolveState& state) const {
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

void InteriorIterate::keep(const SolveState& state) {
  kept_impulse_ = state.impulse;
  kept_s_ = s_;
  kept_z_ = z_;
}

void InteriorIterate::restore(SolveState& state) {
  state.impulse = kept_impulse_;
  s_ = kept_s_;
  z_ = kept_z_;
  state.update_velocity();
}

}  // namespace cleave
