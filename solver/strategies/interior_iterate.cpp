#include "solver/strategies/interior_iterate.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace cleave {
namespace {

// With cones. A second correction saves a factorisation in forty and takes more time than that: on piles of
// 200 and 600 rocks with cfm 1e-6 to 1e-8 steps took 2 to 5 % less without it. Coulomb's law keeps it: two
// piles of the tests are not solved otherwise.
constexpr int kConeCorrections = 1;

}  // namespace

// Impulses of the last step that are not nearly right cost more iterations than starting from none.
void InteriorIterate::choose_impulses(SolveState& state) {
  const double warm = state.residual();
  kept_impulse_ = state.impulse;
  std::ranges::fill(state.impulse, 0.0);
  state.step->set().project(state.impulse);
  state.update_velocity();
  if (constants_.warm_share * state.residual() < warm) return;
  state.impulse = kept_impulse_;
  state.update_velocity();
}

// Every row starts with the same product s z, an energy: at a speed of sqrt(energy d), where light bodies
// have a large d and heavy ones a small one. The same speed everywhere would let the heavy rule the target.
void InteriorIterate::start_rows(SolveState& state, double inside) {
  const int m = state.step->row_count();
  const std::span<const double> diagonal = state.step->diagonal();
  state.chunk_values.resize(state.chunk_count());
  chunk_energy_.resize(state.chunk_count());
  state.run_over_rows([&](int first, int last, int chunk) {
    double energy = 0;
    for (int r = first; r < last; ++r) energy += state.slack[r] * state.slack[r] / diagonal[r];
    chunk_energy_[chunk] = energy;
    state.chunk_values[chunk] =
        SolveState::greatest_of(first, last, [&](int r) { return std::abs(state.slack[r]); });
  });
  const double fastest = SolveState::greatest_of(state.chunk_values);
  const double energy = std::accumulate(chunk_energy_.begin(), chunk_energy_.end(), 0.0) * inside *
                        constants_.start_energy / std::max(m, 1);
  row_speed_.resize(m);
  state.run_over_rows([&](int first, int last, int) {
    for (int r = first; r < last; ++r) {
      const double speed = std::min(std::sqrt(energy * diagonal[r]), constants_.most_speed * fastest);
      row_speed_[r] = std::max(constants_.least_speed_m_per_s, speed);
    }
  });
  barrier_.start(state, row_speed_);
}

void InteriorIterate::start(SolveState& state, double inside) {
  is_to_be_kept_ = false;
  row_error_.resize(state.slack.size());
  choose_impulses(state);
  state.update_shift();
  start_rows(state, inside);
  cones_.start(state, row_speed_);
  shift_.begin(cones_.product_count());
  update_velocity(state);
  measure(state);
}

// With the error of intervals, chunk by chunk, for measure().
void InteriorIterate::update_velocity(SolveState& state, const RowWork& move) {
  state.chunk_values.resize(state.chunk_count());
  if (cones_.product_count() > 0) return state.update_velocity({move, {}});
  const auto find_error = [&](int first, int last, int chunk) {
    state.chunk_values[chunk] = barrier_.error(state, first, last, row_error_);
  };
  state.update_velocity({move, std::ref(find_error)});
}

void InteriorIterate::measure(SolveState& state) {
  error_ =
      cones_.product_count() > 0 ? state.residual_with_shift() : SolveState::greatest_of(state.chunk_values);
}

bool InteriorIterate::factor(SolveState& state, double delta) {
  std::ranges::fill(state.f_v, 0.0);  // in every direction, and an attempt at the end leaves something else
  const StepProblem& problem = state.step->problem();
  const bool has_cones = cones_.product_count() > 0;
  const auto set_compliance = [&](int first, int last, int) {
    for (int r = first; r < last; ++r)
      state.weight[r] = std::max(problem.compliance[r], delta * state.step->diagonal()[r]);
  };
  const auto weigh = [&](int first, int last, int chunk) {
    if (!has_cones) set_compliance(first, last, chunk);
    barrier_.weigh(state, first, last);
  };
  if (has_cones) {
    state.run_over_rows(set_compliance);
    cones_.weigh(state, state.weight);
  }
  return state.factor(std::ref(weigh));
}

void InteriorIterate::find_direction(SolveState& state, Aim aim) {
  choose_target(aim);
  const bool second_order = aim == Aim::mehrotra;
  cones_.aim(state, target_, second_order);
  const auto set_force = [&](int first, int last, int) {
    barrier_.aim(state, first, last, target_, second_order);
  };
  solve(state, std::ref(set_force));
}

void InteriorIterate::choose_target(Aim aim) {
  const double now = mean_product(0);
  if (aim == Aim::affine) target_ = 0;
  if (aim == Aim::centre) target_ = constants_.centring * now;
  if (aim == Aim::mehrotra) {
    const double ratio =
        now > 0 ? mean_product(course_.largest_step) / now : 0;  // without bounds there are no products
    double share = 1;
    for (int power = 0; power < constants_.target_power; ++power) share *= ratio;
    target_ = share * now;
  }
}

void InteriorIterate::add_cones_to_right_hand_side(SolveState& state) const {
  cones_.add_to_right_hand_side(state);
  shift_.subtract_change(state.step->set().cones(), state.f_r);
}

void InteriorIterate::match_shift(SolveState& state, double tolerance, int most) {
  wanted_shift_.resize(state.shift.size());
  shift_.restart();
  for (int k = 0; k < most; ++k) {
    cones_.predict_shift(state, wanted_shift_);
    for (std::size_t c = 0; c < wanted_shift_.size(); ++c) wanted_shift_[c] -= state.shift[c];
    const double apart = shift_.improve(wanted_shift_);
    if (apart <= tolerance) break;
    solve(state, [&](int first, int last, int) { barrier_.right_hand_side(state, first, last); });
  }
}

void InteriorIterate::solve(SolveState& state, const RowWork& set_force) {
  courses_.resize(state.chunk_count());
  const auto follow = [&](int first, int last, int chunk) {
    courses_[chunk] = barrier_.follow(state, first, last);
  };
  if (cones_.product_count() > 0) {
    state.run_over_rows(set_force);
    add_cones_to_right_hand_side(state);
    state.solve({{}, std::ref(follow)});
  } else {
    state.solve({set_force, std::ref(follow)});
  }
  course_ = join_courses(courses_);
  const BarrierCourse of_cones = cones_.follow(state);
  course_.largest_step = std::min(course_.largest_step, of_cones.largest_step);
  for (int power = 0; power < 3; ++power) course_.product[power] += of_cones.product[power];
}

double InteriorIterate::rounding(SolveState& state) {
  state.run_over_rows([&](int first, int last, int) { barrier_.right_hand_side(state, first, last); });
  add_cones_to_right_hand_side(state);
  change_.resize(state.velocity.size());
  row_error_.resize(state.impulse.size());
  state.step->velocity(state.step->set().in_rows(state.dlambda, state.row_impulse), change_);
  for (std::size_t c = 0; c < change_.size(); ++c) change_[c] -= state.step->problem().free_velocity[c];
  state.step->jacobian_times(change_, row_error_);
  state.step->set().to_axes(row_error_);
  const double of_cones = cones_.rounding(state, row_error_);
  return std::max(of_cones, state.greatest_over_rows([&](int r) {
    if (barrier_.is_fixed(r) || barrier_.is_of_cone(r)) return 0.0;
    return std::abs(state.f_r[r] - row_error_[r] - state.dlambda[r] / state.weight[r]);
  }));
}

double InteriorIterate::mean_product(double step) const {
  const std::size_t count = barrier_.product_count() + cones_.product_count();
  if (count == 0) return 0;
  const double* product = course_.product;
  return (product[0] + step * (product[1] + step * product[2])) / static_cast<double>(count);
}

void InteriorIterate::correct_centrality(SolveState& state) {
  const double low = constants_.band * target_, high = target_ / constants_.band;
  const bool has_convex_cones = cones_.product_count() > 0 && !state.step->set().has_coulomb();
  const int most =
      has_convex_cones ? std::min(constants_.corrections, kConeCorrections) : constants_.corrections;
  for (int k = 0; k < most && course_.largest_step < constants_.long_step; ++k) {
    const double step = course_.largest_step, trial = std::min(1.0, step + constants_.reach);
    kept_dlambda_.resize(state.dlambda.size());
    kept_dlambda_.swap(state.dlambda);
    kept_course_ = course_;
    barrier_.swap_directions();
    cones_.correct(state, trial, low, high);
    const auto set_force = [&](int first, int last, int) {
      barrier_.correct(state, first, last, trial, low, high);
    };
    solve(state, std::ref(set_force));
    if (course_.largest_step >= step + constants_.least_gain * (trial - step)) continue;
    state.dlambda.swap(kept_dlambda_);
    course_ = kept_course_;
    barrier_.swap_directions();
    cones_.restore_direction();
    return;
  }
}

void InteriorIterate::advance(SolveState& state, double step) {
  kept_impulse_.resize(state.impulse.size());
  const auto move = [&](int first, int last, int) {
    if (is_to_be_kept_) {
      std::copy(state.impulse.begin() + first, state.impulse.begin() + last, kept_impulse_.begin() + first);
      barrier_.keep(first, last);
    }
    barrier_.advance(state, first, last, step);
  };
  cones_.advance(state, step);
  update_velocity(state, std::ref(move));
  is_to_be_kept_ = false;
  state.update_shift();
  measure(state);
}

void InteriorIterate::keep() {
  is_to_be_kept_ = true;
  cones_.keep();
}

void InteriorIterate::restore(SolveState& state) {
  if (is_to_be_kept_) return;  // no step since
  barrier_.restore();
  cones_.restore();
  state.impulse = kept_impulse_;
  update_velocity(state);
  state.update_shift();
  measure(state);
}

}  // namespace cleave
