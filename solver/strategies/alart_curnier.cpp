#include "solver/strategies/alart_curnier.h"

#include <algorithm>
#include <cmath>

#include "harness/base/stop.h"
#include "harness/base/value_spans.h"
#include "solver/cone.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Of 4500 to 6300 rows none of three steps was solved, in seconds.
constexpr int kMostRows = 2000;
// Two steps take about as long as an iteration of the interior point and its back-substitutions.
constexpr int kStepsAnIteration = 2;
// Of 87 steps of Chain Drop that come right here 78 take no more than these; all are for when both starts
// have had them.
constexpr long kFewSteps = 50;
constexpr int kMostHalvings = 12;
// Of 30 steps of scripts/coulomb_peers that all else leaves unsolved, 25 are solved with so many and 18 with
// one.
constexpr std::size_t kRememberedEnergies = 5;
constexpr double kLeastFall = 2e-4;  // of the energy, in units of the step's length
constexpr int kCorrections = 2;      // of what rounding did to a step

// What F compares the impulses of a contact with; y = lambda - rho w.
Vector3d project_contact(double mu, const Vector3d& y) {
  const double normal = std::max(y[0], 0.0), t = tangential(y), radius = mu * normal;
  const double share = t <= radius ? 1.0 : radius / t;
  return {normal, share * y[1], share * y[2]};
}

Matrix3d differentiate_contact(double mu, const Vector3d& y, int rows) {
  Matrix3d derivative = Matrix3d::Zero();
  const double t = tangential(y), radius = mu * std::max(y[0], 0.0);
  if (y[0] > 0) derivative(0, 0) = 1;
  if (t <= radius) {
    for (int k = 1; k < rows; ++k) derivative(k, k) = 1;
  } else if (y[0] > 0) {
    const Vector3d u(0, y[1] / t, y[2] / t);
    for (int i = 1; i < rows; ++i) {
      derivative(i, 0) = mu * u[i];
      for (int j = 1; j < rows; ++j) derivative(i, j) = radius / t * ((i == j ? 1.0 : 0.0) - u[i] * u[j]);
    }
  }
  return derivative;
}

}  // namespace

Vector3d AlartCurnier::Block::load(std::span<const double> x) const {
  Vector3d value = Vector3d::Zero();
  for (int k = 0; k < row_count; ++k) value[k] = x[first_row + k];
  return value;
}

void AlartCurnier::Block::store(const Vector3d& value, std::span<double> x) const {
  for (int k = 0; k < row_count; ++k) x[first_row + k] = value[k];
}

Vector3d AlartCurnier::Block::aim(const SolveState& state) const {
  return load(state.impulse) - rho.cwiseProduct(load(state.slack));
}

Vector3d AlartCurnier::Block::project(const StepProblem& problem, const Vector3d& y) const {
  if (cone != nullptr) return project_contact(cone->mu, y);
  return {std::clamp(y[0], problem.lower[first_row], problem.upper[first_row]), 0, 0};
}

Matrix3d AlartCurnier::Block::differentiate(const StepProblem& problem, const Vector3d& y) const {
  if (cone != nullptr) return differentiate_contact(cone->mu, y, row_count);
  Matrix3d derivative_of_row = Matrix3d::Zero();
  if (problem.lower[first_row] < y[0] && y[0] < problem.upper[first_row]) derivative_of_row(0, 0) = 1;
  return derivative_of_row;
}

void AlartCurnier::Block::linearize(const SolveState& state) {
  derivative = differentiate(state.step->problem(), aim(state));
  const Vector3d least = kFactoredCompliance * load(state.step->diagonal());
  const Vector3d compliance = load(state.step->problem().compliance).cwiseMax(least);
  const Matrix3d scaled = derivative * rho.asDiagonal();
  g_inverse = (Matrix3d::Identity() - derivative + scaled * compliance.asDiagonal()).inverse();
  e = g_inverse * scaled;
}

// The law is that of the slacks without the shift.
void AlartCurnier::load(SolveState& state, std::span<const double> impulse) const {
  state.impulse.assign(impulse.begin(), impulse.end());
  std::ranges::fill(state.shift, 0.0);
  state.update_velocity();
}

void AlartCurnier::list_blocks(const SolveState& state) {
  const std::span<const double> d = state.step->diagonal();
  blocks_.clear();
  auto next = state.step->set().cones().begin();
  for (int r = 0; r < std::ssize(d);) {
    const bool is_contact = next != state.step->set().cones().end() && next->first_row == r;
    Block& block = blocks_.emplace_back();
    block.first_row = r;
    block.row_count = is_contact ? next->row_count : 1;
    block.cone = is_contact ? &*next++ : nullptr;
    block.rho.setZero();
    block.rho.head(block.row_count).setConstant(1 / d[r]);  // d is one number on all rows of a contact
    r += block.row_count;
  }
}

double AlartCurnier::find_error(const SolveState& state) {
  error_.resize(state.impulse.size());
  double energy = 0;
  for (const Block& block : blocks_) {
    const Vector3d error = block.load(state.impulse) - block.project(state.step->problem(), block.aim(state));
    block.store(error, error_);
    for (int k = 0; k < block.row_count; ++k) energy += error[k] * error[k] / block.rho[k];
  }
  return energy;
}

// M + J^T E J of the present impulses.
void AlartCurnier::assemble(const SolveState& state) {
  const StepProblem& problem = state.step->problem();
  triplets_.clear();
  for (int body = 0; body < problem.body_count(); ++body) {
    for (int k = 0; k < 36; ++k)
      triplets_.emplace_back(6 * body + k / 6, 6 * body + k % 6, problem.mass[36L * body + k]);
  }
  for (Block& block : blocks_) {
    block.linearize(state);
    add_block(problem, block);
  }
}

// On all places of the block's pattern, zero or not, which stays the same from step to step.
void AlartCurnier::add_block(const StepProblem& problem, const Block& block) {
  Eigen::Matrix<double, 3, 12> j = Eigen::Matrix<double, 3, 12>::Zero();
  for (int k = 0; k < block.row_count; ++k)
    j.row(k) =
        Eigen::Map<const Eigen::Matrix<double, 1, 12>>(problem.jacobian.data() + 12L * (block.first_row + k));
  const Eigen::Matrix<double, 12, 12> product = j.transpose() * block.e * j;
  const int* body = problem.row_body.data() + 2L * block.first_row;
  const auto place = [&](int c) { return 6 * body[c / 6] + c % 6; };
  const int count = body[1] < 0 ? 6 : 12;
  for (int c = 0; c < count; ++c) {
    for (int r = 0; r < count; ++r) triplets_.emplace_back(place(r), place(c), product(r, c));
  }
}

bool AlartCurnier::factor(SolveState& state) {
  check_stop(state.options.stop);
  assemble(state);
  const bool is_first = matrix_.rows() == 0;
  const int size = 6 * state.step->problem().body_count();
  matrix_.resize(size, size);
  matrix_.setFromTriplets(triplets_.begin(), triplets_.end());
  if (is_first) lu_.analyzePattern(matrix_);
  lu_.factorize(matrix_);
  ++state.summary->factorizations;
  return lu_.info() == Eigen::Success;
}

// dlambda of right-hand side -rest, added to the step; rest becomes -g.
void AlartCurnier::find_step(const SolveState& state) {
  const std::size_t size = state.velocity.size();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size));
  for (const Block& block : blocks_) block.store(-(block.g_inverse * block.load(rest_)), rest_);
  state.step->add_jacobian_transpose(rest_, {force.data(), size});
  const Eigen::VectorXd change = lu_.solve(force);
  state.step->jacobian_times({change.data(), size}, row_velocity_);
  for (const Block& block : blocks_) {
    const Vector3d moved = block.load(rest_) - block.e * block.load(row_velocity_);
    block.store(block.load(step_) + moved, step_);
  }
}

// What is left of the step's equation, with the velocities of its own impulses, is solved for again.
void AlartCurnier::correct_step(const SolveState& state) {
  const StepProblem& problem = state.step->problem();
  state.step->velocity(step_, step_velocity_);
  for (std::size_t c = 0; c < step_velocity_.size(); ++c) step_velocity_[c] -= problem.free_velocity[c];
  state.step->jacobian_times(step_velocity_, row_velocity_);
  for (const Block& block : blocks_) {
    const Vector3d step = block.load(step_), compliance = block.load(problem.compliance);
    const Vector3d change = block.load(row_velocity_) + compliance.cwiseProduct(step);
    const Vector3d moved = block.derivative * (block.rho.cwiseProduct(change) - step);
    block.store(block.load(error_) + step + moved, rest_);
  }
  find_step(state);
}

// So much of the step from where it began. Returns the energy there.
double AlartCurnier::move(SolveState& state, double length) {
  for (std::size_t r = 0; r < step_.size(); ++r) state.impulse[r] = impulse_before_[r] + length * step_[r];
  state.update_velocity();
  return find_error(state);
}

// All of the step, or the first of its halves, quarters, ... whose energy is below the limit, or else all.
// Returns the energy.
double AlartCurnier::take_step(SolveState& state, double energy_limit) {
  impulse_before_ = state.impulse;
  for (int k = 0; k <= kMostHalvings; ++k) {
    const double length = std::ldexp(1.0, -k), energy = move(state, length);
    if (energy <= (1 - kLeastFall * length) * energy_limit) return energy;
  }
  return move(state, 1);
}

bool AlartCurnier::attempt(SolveState& state, std::span<const double> start, long most) {
  load(state, start);
  energies_.assign(1, find_error(state));
  for (long k = 0; k <= most; ++k) {
    const double residual = state.residual();
    if (residual < best_residual_) best_residual_ = residual, best_impulse_ = state.impulse;
    if (residual <= state.target_m_per_s()) return true;
    if (k == most || !factor(state)) break;
    ++state.summary->iterations;
    step_.assign(error_.size(), 0.0);
    rest_ = error_;
    find_step(state);
    for (int c = 0; c < kCorrections; ++c) correct_step(state);
    if (!all_finite(step_)) break;
    energies_.push_back(take_step(state, *std::max_element(energies_.begin(), energies_.end())));
    if (energies_.size() > kRememberedEnergies) energies_.pop_front();
  }
  return best_residual_ <= state.step->exact_limit_m_per_s();
}

bool AlartCurnier::run(SolveState& state, std::span<const double> warm_impulse) {
  const ImpulseSet& set = state.step->set();
  const bool is_law = std::ranges::all_of(set.cones(), [](const FrictionCone& cone) { return cone.coulomb; });
  if (!is_law || !set.axes().empty() || state.step->row_count() > kMostRows) return false;
  best_residual_ = state.residual();
  best_impulse_ = state.impulse;
  std::vector<double> none(state.impulse.size(), 0.0);
  set.project(none);
  matrix_.resize(0, 0);
  list_blocks(state);
  row_velocity_.resize(none.size());
  step_velocity_.resize(state.velocity.size());
  const long most = long{kStepsAnIteration} * state.options.max_iterations;
  bool solved = false;
  for (const long steps : {std::min(kFewSteps, most), most})
    solved = solved || attempt(state, none, steps) || attempt(state, warm_impulse, steps);
  state.load(best_impulse_);
  return solved;
}

}  // namespace cleave
