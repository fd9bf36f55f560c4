#include "solver/strategies/interval_barrier.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace cleave {
namespace {

constexpr int kLanes = 4;  // running values side by side, for vector instructions

// By value: std::max and std::min choose between addresses, which keeps loops from becoming vector
// instructions.
double greater(double a, double b) { return a < b ? b : a; }
double lesser(double a, double b) { return b < a ? b : a; }

}  // namespace

BarrierCourse join_courses(std::span<const ChunkCourse> chunks) {
  BarrierCourse course;
  double inverse_step = 1;
  for (const ChunkCourse& part : chunks) {
    inverse_step = std::max(inverse_step, part.inverse_step);
    for (int power = 0; power < 3; ++power) course.product[power] += part.product[power];
  }
  course.largest_step = 1 / inverse_step;
  return course;
}

std::array<std::vector<double>*, 14> IntervalBarrier::Side::zeros_at_start() {
  return {&is_there, &bound, &z,         &inverse_s, &inverse_z, &gap,    &now.ds,
          &now.dz,   &now.c, &before.ds, &before.dz, &before.c,  &kept_s, &kept_z};
}

void IntervalBarrier::Side::resize(std::size_t rows) {
  s.resize(rows);
  for (std::vector<double>* v : zeros_at_start()) v->resize(rows);
}

void IntervalBarrier::Side::start(int first, int last) {
  std::fill(s.begin() + first, s.begin() + last, 1.0);
  for (std::vector<double>* v : zeros_at_start()) std::fill(v->begin() + first, v->begin() + last, 0.0);
}

void IntervalBarrier::Side::add(int r, double value, double impulse, double multiplier) {
  is_there[r] = 1;
  bound[r] = value;
  s[r] = sign * (impulse - value);
  z[r] = multiplier;
}

int IntervalBarrier::add_bounds(SolveState& state, int r, double speed) {
  const StepProblem& problem = state.step->problem();
  const double d = state.step->diagonal()[r], w = state.slack[r];
  const double lower = problem.lower[r], upper = problem.upper[r], width = upper - lower;
  const double rounding = std::numeric_limits<double>::epsilon() * std::abs(lower);
  if (d * width <= constants_.fixed_width_m_per_s ||
      (std::isfinite(width) && width <= constants_.fixed_roundings * rounding)) {
    use_[r] = RowUse::fixed;
    moves_[r] = 0;
    state.impulse[r] = 0.5 * (lower + upper);
    return 0;
  }
  // The impulse itself moves inside, so that slacks start feasible even where the bounds are close together.
  const double margin = std::min(speed / d, constants_.inside_share * width);
  if (std::isfinite(lower)) state.impulse[r] = std::max(state.impulse[r], lower + margin);
  if (std::isfinite(upper)) state.impulse[r] = std::min(state.impulse[r], upper - margin);
  int bounds = 0;
  for (Side& side : sides_) {
    const double bound = side.sign > 0 ? lower : upper;
    if (!std::isfinite(bound)) continue;
    side.add(r, bound, state.impulse[r], std::max(side.sign * w, 0.0) + speed);
    ++bounds;
  }
  return bounds;
}

void IntervalBarrier::start(SolveState& state, std::span<const double> speed) {
  for (Side& side : sides_) side.resize(speed.size());
  moves_.resize(speed.size());
  use_.assign(speed.size(), RowUse::bounded);
  for (const FrictionCone& cone : state.step->set().cones())
    std::fill_n(use_.begin() + cone.first_row, cone.row_count, RowUse::of_cone);
  chunk_bounds_.resize(state.chunk_count());
  state.run_over_rows([&](int first, int last, int chunk) {
    for (Side& side : sides_) side.start(first, last);
    std::fill(moves_.begin() + first, moves_.begin() + last, 1.0);
    int bounds = 0;
    for (int r = first; r < last; ++r)
      if (!is_of_cone(r)) bounds += add_bounds(state, r, speed[r]);
    chunk_bounds_[chunk] = bounds;
  });
  bounds_ = std::accumulate(chunk_bounds_.begin(), chunk_bounds_.end(), std::size_t{0});
}

void IntervalBarrier::Side::weigh(int first, int last, std::span<const double> impulse,
                                  std::span<double> weight) {
#pragma omp simd
  for (int r = first; r < last; ++r) {
    inverse_s[r] = 1 / s[r];
    inverse_z[r] = 1 / (z[r] + (1 - is_there[r]));
    gap[r] = is_there[r] * (sign * (impulse[r] - bound[r]) - s[r]);
    weight[r] += z[r] * inverse_s[r];
  }
}

void IntervalBarrier::weigh(SolveState& state, int first, int last) {
  for (Side& side : sides()) side.weigh(first, last, state.impulse, state.weight);
#pragma omp simd
  for (int r = first; r < last; ++r) state.weight[r] = moves_[r] / state.weight[r];
}

void IntervalBarrier::Side::aim(int first, int last, double product, double share) {
#pragma omp simd
  for (int r = first; r < last; ++r)
    now.c[r] = is_there[r] * product - s[r] * z[r] - share * now.ds[r] * now.dz[r];
}

void IntervalBarrier::Side::add_force(int first, int last, std::span<double> f_r) const {
#pragma omp simd
  for (int r = first; r < last; ++r) f_r[r] += sign * (z[r] + (now.c[r] - z[r] * gap[r]) * inverse_s[r]);
}

void IntervalBarrier::right_hand_side(SolveState& state, int first, int last) const {
#pragma omp simd
  for (int r = first; r < last; ++r) state.f_r[r] = -moves_[r] * state.slack[r];
  for (const Side& side : sides()) side.add_force(first, last, state.f_r);
}

void IntervalBarrier::aim(SolveState& state, int first, int last, double product, bool second_order) {
  for (Side& side : sides()) side.aim(first, last, product, second_order ? 1.0 : 0.0);
  right_hand_side(state, first, last);
}

void IntervalBarrier::Side::follow(int first, int last, std::span<const double> dlambda,
                                   ChunkCourse& course) {
  double fastest[kLanes] = {}, sum[3][kLanes] = {};
  const auto visit = [&](int r, int lane) {
    const double ds = is_there[r] * (sign * dlambda[r]) + gap[r];
    const double dz = (now.c[r] - z[r] * ds) * inverse_s[r];
    now.ds[r] = ds;
    now.dz[r] = dz;
    fastest[lane] = greater(fastest[lane], greater(-ds * inverse_s[r], -dz * inverse_z[r]));
    sum[0][lane] += s[r] * z[r];
    sum[1][lane] += s[r] * dz + z[r] * ds;
    sum[2][lane] += ds * dz;
  };
  const int whole = first + (last - first) / kLanes * kLanes;
  for (int r = first; r < whole; r += kLanes) {
#pragma omp simd
    for (int lane = 0; lane < kLanes; ++lane) visit(r + lane, lane);
  }
  for (int r = whole; r < last; ++r) visit(r, r - whole);
  course.inverse_step = std::max(course.inverse_step, *std::max_element(fastest, fastest + kLanes));
  for (int power = 0; power < 3; ++power)
    course.product[power] += std::accumulate(sum[power], sum[power] + kLanes, 0.0);
}

ChunkCourse IntervalBarrier::follow(const SolveState& state, int first, int last) {
  ChunkCourse course;
  for (Side& side : sides()) side.follow(first, last, state.dlambda, course);
  return course;
}

void IntervalBarrier::Side::correct(int first, int last, double trial, double low, double high) {
#pragma omp simd
  for (int r = first; r < last; ++r) {
    const double product = (s[r] + trial * before.ds[r]) * (z[r] + trial * before.dz[r]);
    const double short_of = greater(low - product, 0.0), beyond = greater(lesser(high - product, 0.0), -high);
    now.c[r] = before.c[r] + is_there[r] * (short_of + beyond);
  }
}

void IntervalBarrier::correct(SolveState& state, int first, int last, double trial, double low, double high) {
  for (Side& side : sides()) side.correct(first, last, trial, low, high);
  right_hand_side(state, first, last);
}

void IntervalBarrier::swap_directions() {
  for (Side& side : sides_) std::swap(side.now, side.before);
}

void IntervalBarrier::advance(SolveState& state, int first, int last, double step) {
#pragma omp simd
  for (int r = first; r < last; ++r) state.impulse[r] += step * moves_[r] * state.dlambda[r];
  for (Side& side : sides()) {
#pragma omp simd
    for (int r = first; r < last; ++r) {
      side.s[r] += step * side.now.ds[r];
      side.z[r] += step * side.now.dz[r];
    }
  }
}

double IntervalBarrier::Side::error(int first, int last, std::span<const double> d,
                                    std::span<double> row_error) const {
  double worst = 0;
#pragma omp simd reduction(max : worst)
  for (int r = first; r < last; ++r) {
    worst = greater(worst, lesser(d[r] * s[r], z[r]));
    row_error[r] -= sign * z[r];
  }
  return worst;
}

double IntervalBarrier::error(const SolveState& state, int first, int last,
                              std::span<double> row_error) const {
#pragma omp simd
  for (int r = first; r < last; ++r) row_error[r] = moves_[r] * state.slack[r];
  double worst = 0;
  for (const Side& side : sides())
    worst = std::max(worst, side.error(first, last, state.step->diagonal(), row_error));
  return std::max(worst, state.greatest_of(first, last, [&](int r) { return std::abs(row_error[r]); }));
}

void IntervalBarrier::read_active_set(SolveState& state) const {
  state.run_over_rows([&](int first, int last, int) {
    for (int r = first; r < last; ++r) {
      state.row_state[r] = is_fixed(r) ? RowState::lower : RowState::free;
      for (const Side& side : sides_) {
        if (state.step->diagonal()[r] * side.s[r] < side.z[r])
          state.row_state[r] = side.sign > 0 ? RowState::lower : RowState::upper;
      }
    }
  });
}

void IntervalBarrier::Side::keep(int first, int last) {
  std::copy(s.begin() + first, s.begin() + last, kept_s.begin() + first);
  std::copy(z.begin() + first, z.begin() + last, kept_z.begin() + first);
}

void IntervalBarrier::keep(int first, int last) {
  for (Side& side : sides()) side.keep(first, last);
}

void IntervalBarrier::restore() {
  for (Side& side : sides()) side.s = side.kept_s, side.z = side.kept_z;
}

}  // namespace cleave
