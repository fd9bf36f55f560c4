#include "solver/strategies/cone_newton.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "solver/cone.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

constexpr int kMostSteps = 8;
constexpr double kLeastFall = 0.5;  // of the least residual in a step that is worth the next

// Under Coulomb's law, where steps from afar change the energy little until the last few square it: given up
// where it does not fall to this share in so many steps. A step must lower the greatest of so many earlier
// energies. Of 214 steps of the scenes 190 are then solved from the impulses of the step before; where every
// step had to lower the last energy, and three of them to this share, 105 were.
constexpr int kMostLawSteps = 40, kMostHalvings = 8, kMostSolves = 12;
constexpr std::size_t kWatchedSteps = 10, kRememberedSteps = 3;
constexpr double kLeastEnergyFall = 0.25;

// How exact the change of the shift is found, as a share of what it is off at first: by the fall of the
// energy in the step before, since a step that is halved gains nothing from digits and the last ones do.
constexpr double kShareOfFall = 0.9, kMostInexact = 0.2, kMostExact = 1e-3, kFirstInexact = 0.1;

// By the least C_r / d_r: the residual in units of the velocity scale from where steps were seen to converge,
// and how many of them in a row may bring no new least. On piles of 200 and 600 rocks a tenth of these
// residuals took 13 % more time at cfm 1e-4 and 3 to 6 % more at 1e-12 and 1e-14; in between ten times as
// much saved no factorisation. The first step may raise the residual a thousandfold before the next ones
// bring it down: to give up there cost up to three quarters more factorisations where rows are soft.
struct Attempt {
  double least_compliance, first_residual;
  int most_without_fall;
};
constexpr Attempt kAttempts[] = {  // the last one for all the rest
    {1e-2, 1e-3, 3}, {1e-3, 1e-4, 3}, {1e-4, 1e-6, 2}, {1e-6, 1e-8, 2}, {1e-9, 1e-8, 1}, {0, 1e-9, 1}};

const Attempt& attempt_at(double least_compliance) {
  return *std::find_if(std::begin(kAttempts), std::end(kAttempts) - 1,
                       [&](const Attempt& attempt) { return least_compliance >= attempt.least_compliance; });
}

// The derivative of the projection on a cone: orthonormal eigenvectors, of which a contact with one tangent
// has the first two, and their eigenvalues.
struct Derivative {
  std::array<Vector3d, 3> vector{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  std::array<double, 3> theta{};
};

Derivative differentiate(double mu, const Vector3d& p) {
  Derivative derivative;
  const double t = tangential(p);
  if (mu * t <= -p[0]) return derivative;
  if (t <= mu * p[0]) {
    derivative.theta = {1, 1, 1};
    return derivative;
  }
  const Vector3d u(0, p[1] / t, p[2] / t);
  const double length = std::sqrt(1 + mu * mu);
  derivative.vector = {(Vector3d::UnitX() + mu * u) / length, (mu * Vector3d::UnitX() - u) / length,
                       Vector3d(0, -u[2], u[1])};
  derivative.theta = {1, 0, mu * (p[0] + mu * t) / (length * length * t)};
  return derivative;
}

template <class Task>
void over_rows(SolveState& state, const Task& task) {
  state.run_over_rows([&](int first, int last, int) {
    for (int r = first; r < last; ++r) task(r);
  });
}

}  // namespace

// Weights of rows with bounds; theta = 0 sets the impulse to its bound. The rows of cones are
// linearize_cone's.
void ConeNewton::linearize_rows(SolveState& state, int first, int last) const {
  const StepProblem& problem = state.step->problem();
  const std::span<const double> d = state.step->diagonal();
  for (int r = first; r < last; ++r) {
    const double p = state.impulse[r] - state.slack[r] / d[r];
    const bool is_free = problem.lower[r] < p && p < problem.upper[r];
    state.weight[r] = is_free ? 1 / std::max(problem.compliance[r], kFactoredCompliance * d[r]) : 0.0;
    if (!is_free) state.impulse[r] = std::clamp(p, problem.lower[r], problem.upper[r]);
  }
}

void ConeNewton::linearize_cone(SolveState& state, const FrictionCone& cone) {
  const std::ptrdiff_t k = &cone - state.step->set().cones().data();
  const double d = state.step->diagonal()[cone.first_row];
  const Vector3d impulse = load_contact(cone, impulse_before_), slack = load_contact(cone, slack_before_);
  const Vector3d compliance = load_contact(cone, state.step->problem().compliance);
  const Vector3d apart = cone_residual(cone.mu, d, impulse, slack);
  const Derivative at = differentiate(cone.mu, impulse - slack / d);
  const bool sticks = at.theta[1] > 0;
  slides_[k] = cone.coulomb && at.theta[0] > 0 && !sticks;
  Vector3d wanted = slack, moved = impulse;
  for (int i = 0; i < cone.row_count; ++i) {
    const Vector3d& e = at.vector[i];
    const double theta = at.theta[i];
    std::copy_n(e.data(), cone.row_count, state.cone_blocks()[k].basis.data() + cone.row_count * i);
    if (theta > 0) {
      const double own = std::max(e.cwiseAbs2().dot(compliance), kFactoredCompliance * d);
      state.weight[cone.first_row + i] = 1 / (own + d * (1 - theta) / theta);
      wanted -= e.dot(apart) / theta * e;
    } else {
      state.weight[cone.first_row + i] = 0;
      moved -= e.dot(apart) / d * e;
    }
  }
  if (cone.coulomb && sticks) wanted[0] += cone.mu * tangential(slack);  // the shift goes with w_t
  store_contact(cone, wanted, wanted_);
  store_contact(cone, moved, state.impulse);
}

// The impulses after a full step. False where the kernel finds a non-positive pivot.
bool ConeNewton::find_step(SolveState& state) {
  const ImpulseSet& set = state.step->set();
  wanted_.assign(state.impulse.size(), 0.0);
  slides_.resize(set.cones().size());
  impulse_before_ = state.impulse;
  slack_before_ = state.slack;
  state.run_over_rows([&](int first, int last, int) {
    set.visit_intervals(first, last, [&](int begin, int end) { linearize_rows(state, begin, end); });
    for (const FrictionCone& cone : set.cones_of(first, last)) linearize_cone(state, cone);
  });
  state.update_velocity();
  if (!state.factor()) return false;
  solve(state);
  over_rows(state, [&](int r) { state.impulse[r] += state.dlambda[r]; });
  return true;
}

double ConeNewton::shift_accuracy() const {
  const std::size_t count = energies_.size();
  if (count < 2) return kFirstInexact;
  return std::clamp(kShareOfFall * energies_[count - 1] / energies_[count - 2], kMostExact, kMostInexact);
}

void ConeNewton::solve(SolveState& state) {
  if (has_coulomb_) shift_.begin(state, slack_before_, slides_, shift_accuracy());
  std::ranges::fill(state.f_v, 0.0);
  for (int k = 0; k < kMostSolves; ++k) {
    over_rows(state, [&](int r) { state.f_r[r] = wanted_[r] - state.slack[r]; });
    if (has_coulomb_) shift_.add_to_right_hand_side(state);
    state.solve();
    ++state.summary->refinements;
    if (!has_coulomb_ || shift_.is_matched(state)) break;
  }
}

// Chunks are summed in their order.
ImpulseSet::Misses ConeNewton::misses(SolveState& state) {
  chunk_energy_.assign(state.chunk_count(), 0.0);
  const double largest = state.greatest_over_chunks([&](int first, int last, int chunk) {
    const ImpulseSet::Misses of_chunk =
        state.step->set().misses(first, last, state.step->diagonal(), state.impulse, state.slack);
    chunk_energy_[chunk] = of_chunk.energy;
    return of_chunk.largest;
  });
  return {largest, std::accumulate(chunk_energy_.begin(), chunk_energy_.end(), 0.0)};
}

double ConeNewton::energy_to_beat() const {
  const auto remembered = std::min(energies_.size(), kRememberedSteps);
  return *std::max_element(energies_.end() - static_cast<std::ptrdiff_t>(remembered), energies_.end());
}

// All of the step, or under Coulomb's law the first of its halves, quarters, ... whose energy is low enough.
// Returns the residual.
double ConeNewton::take_step(SolveState& state) {
  const double most_energy = energy_to_beat();
  state.update_velocity_and_shift();
  ImpulseSet::Misses after = misses(state);
  for (int k = 0; has_coulomb_ && k < kMostHalvings && !(after.energy < most_energy); ++k) {
    over_rows(state, [&](int r) { state.impulse[r] = 0.5 * (state.impulse[r] + impulse_before_[r]); });
    state.update_velocity_and_shift();
    after = misses(state);
  }
  energies_.push_back(after.energy);
  return after.largest;
}

// Whether the last steps were worth the next.
bool ConeNewton::falls() const {
  if (!has_coulomb_) return without_fall_ < most_without_fall_;
  const std::size_t count = energies_.size();
  return count <= kWatchedSteps ||
         energies_[count - 1] < kLeastEnergyFall * energies_[count - 1 - kWatchedSteps];
}

double ConeNewton::first_residual(double least_compliance) {
  return attempt_at(least_compliance).first_residual;
}

double ConeNewton::run(SolveState& state, double target) {
  has_coulomb_ = state.step->set().has_coulomb();
  if (has_coulomb_) state.update_velocity_and_shift();
  const ImpulseSet::Misses start = misses(state);
  double least = start.largest;
  best_impulse_ = state.impulse;
  without_fall_ = 0;
  most_without_fall_ = attempt_at(state.step->least_relative_compliance()).most_without_fall;
  energies_.reserve(kMostLawSteps + 1);
  energies_.assign(1, start.energy);
  const int most = has_coulomb_ ? kMostLawSteps : kMostSteps;
  for (int k = 0; k < most && least > target && find_step(state); ++k) {
    const double residual = take_step(state);
    without_fall_ = residual < kLeastFall * least ? 0 : without_fall_ + 1;
    if (residual < least) least = residual, best_impulse_ = state.impulse;
    if (!falls()) break;
  }
  state.load(best_impulse_);
  return least;
}

}  // namespace cleave
