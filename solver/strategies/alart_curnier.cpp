#include "solver/strategies/alart_curnier.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/stop.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Of 4500 to 6300 rows none of three steps was solved, in seconds.
constexpr int kMostRows = 2000;
// Two steps take about as long as an iteration of the interior point and its back-substitutions. On 29 steps of chains and piles
// that nothing else had solved, 21 were in twice a hundred from zero and 3 more in as many from the step before; memories of 3 and 12
// energies solved fewer.
constexpr int kStepsAnIteration = 2;
constexpr int kMostHalvings = 12;
constexpr std::size_t kRememberedEnergies = 5;
constexpr double kLeastFall = 2e-4;  // of the energy, in units of the step's length
constexpr int kCorrections = 2;      // of what rounding did to a step

// The rows of a block, of which there are up to three, as a vector, and back.
Vector3d load_rows(std::span<const double> x, int first, int rows) {
  Vector3d value = Vector3d::Zero();
  for (int k = 0; k < rows; ++k) value[k] = x[first + k];
  return value;
}

void store_rows(const Vector3d& value, std::span<double> x, int first, int rows) {
  for (int k = 0; k < rows; ++k) x[first + k] = value[k];
}

// What F compares the impulses of a contact with; y = lambda - rho w.
Vector3d project(double mu, const Vector3d& y) {
  const double normal = std::max(y[0], 0.0), t = tangential(y), radius = mu * normal;
  const double share = t <= radius ? 1.0 : radius / t;
  return {normal, share * y[1], share * y[2]};
}

Matrix3d differentiate(double mu, const Vector3d& y, int rows) {
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

void AlartCurnier::load(SolveState& state, std::span<const double> impulse) const {
  state.impulse.assign(impulse.begin(), impulse.end());
  std::ranges::fill(state.shift, 0.0);
  state.update_velocity();
}

// Rows in blocks: contacts, and every other row by itself.
void AlartCurnier::choose_rho(const SolveState& state) {
  const std::span<const double> d = state.step->diagonal();
  rho_.resize(d.size());
  block_first_.clear(), block_rows_.clear(), block_cone_.clear();
  auto next = state.step->set().cones().begin();
  for (int r = 0; r < std::ssize(d);) {
    const bool is_contact = next != state.step->set().cones().end() && next->first_row == r;
    const int rows = is_contact ? next->row_count : 1;
    const double of_tangents = is_contact ? *std::max_element(d.begin() + r + 1, d.begin() + r + rows) : 0;
    for (int k = 0; k < rows; ++k) rho_[r + k] = 1 / (k == 0 ? d[r] : of_tangents);
    block_first_.push_back(r);
    block_rows_.push_back(rows);
    block_cone_.push_back(is_contact ? &*next++ : nullptr);
    r += rows;
  }
  e_.resize(block_first_.size());
  g_inverse_.resize(block_first_.size());
  derivative_.resize(block_first_.size());
}

double AlartCurnier::find_error(const SolveState& state) {
  const StepProblem& problem = state.step->problem();
  error_.resize(rho_.size());
  double energy = 0;
  for (std::size_t b = 0; b < block_first_.size(); ++b) {
    const int first = block_first_[b], rows = block_rows_[b];
    const Vector3d impulse = load_rows(state.impulse, first, rows), rho = load_rows(rho_, first, rows);
    const Vector3d y = impulse - rho.cwiseProduct(load_rows(state.slack, first, rows));
    Vector3d error = Vector3d::Zero();
    if (block_cone_[b] != nullptr) {
      error = impulse - project(block_cone_[b]->mu, y);
    } else {
      error[0] = impulse[0] - std::clamp(y[0], problem.lower[first], problem.upper[first]);
    }
    store_rows(error, error_, first, rows);
    for (int k = 0; k < rows; ++k) energy += error[k] * error[k] / rho[k];
  }
  return energy;
}

// P', G^-1 and E of every block, and the matrix.
void AlartCurnier::linearize(const SolveState& state) {
  const StepProblem& problem = state.step->problem();
  triplets_.clear();
  for (int body = 0; body < problem.body_count(); ++body) {
    for (int k = 0; k < 36; ++k)
      triplets_.emplace_back(6 * body + k / 6, 6 * body + k % 6, problem.mass[36L * body + k]);
  }
  for (std::size_t b = 0; b < block_first_.size(); ++b) {
    const int first = block_first_[b], rows = block_rows_[b];
    const Vector3d rho = load_rows(rho_, first, rows);
    const Vector3d y =
        load_rows(state.impulse, first, rows) - rho.cwiseProduct(load_rows(state.slack, first, rows));
    if (block_cone_[b] != nullptr) {
      derivative_[b] = differentiate(block_cone_[b]->mu, y, rows);
    } else {
      derivative_[b].setZero();
      derivative_[b](0, 0) = problem.lower[first] < y[0] && y[0] < problem.upper[first] ? 1 : 0;
    }
    Vector3d compliance = Vector3d::Zero();
    for (int k = 0; k < rows; ++k)
      compliance[k] =
          std::max(problem.compliance[first + k], kFactoredCompliance * state.step->diagonal()[first + k]);
    const Matrix3d scaled = derivative_[b] * rho.asDiagonal();
    g_inverse_[b] = (Matrix3d::Identity() - derivative_[b] + scaled * compliance.asDiagonal()).inverse();
    e_[b] = g_inverse_[b] * scaled;
    add_block(problem, first, rows, e_[b]);
  }
}

// J^T E J of the rows of a block, on all places of its pattern, zero or not, which stays the same from step to step.
void AlartCurnier::add_block(const StepProblem& problem, int first_row, int rows, const Matrix3d& e) {
  Eigen::Matrix<double, 3, 12> j = Eigen::Matrix<double, 3, 12>::Zero();
  for (int k = 0; k < rows; ++k)
    j.row(k) =
        Eigen::Map<const Eigen::Matrix<double, 1, 12>>(problem.jacobian.data() + 12L * (first_row + k));
  const Eigen::Matrix<double, 12, 12> block = j.transpose() * e * j;
  const int* body = problem.row_body.data() + 2L * first_row;
  const auto place = [&](int c) { return 6 * body[c / 6] + c % 6; };
  const int count = body[1] < 0 ? 6 : 12;
  for (int c = 0; c < count; ++c) {
    for (int r = 0; r < count; ++r) triplets_.emplace_back(place(r), place(c), block(r, c));
  }
}

bool AlartCurnier::factor(SolveState& state) {
  check_stop(state.options.stop);
  linearize(state);
  const bool is_first = matrix_.rows() == 0;
  const int size = 6 * state.step->problem().body_count();
  matrix_.resize(size, size);
  matrix_.setFromTriplets(triplets_.begin(), triplets_.end());
  if (is_first) lu_.analyzePattern(matrix_);
  lu_.factorize(matrix_);
  ++state.summary->factorizations;
  return lu_.info() == Eigen::Success;
}

// dlambda of right-hand side -rest, added to the step.
void AlartCurnier::find_step(const SolveState& state) {
  const int size = 6 * state.step->problem().body_count();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(size);
  for (std::size_t b = 0; b < block_first_.size(); ++b)
    store_rows(-(g_inverse_[b] * load_rows(rest_, block_first_[b], block_rows_[b])), rest_, block_first_[b],
               block_rows_[b]);
  state.step->add_jacobian_transpose(rest_, {force.data(), static_cast<std::size_t>(size)});
  const Eigen::VectorXd change = lu_.solve(force);
  state.step->jacobian_times({change.data(), static_cast<std::size_t>(size)}, row_velocity_);
  for (std::size_t b = 0; b < block_first_.size(); ++b) {
    const int first = block_first_[b], rows = block_rows_[b];
    const Vector3d moved = load_rows(rest_, first, rows) - e_[b] * load_rows(row_velocity_, first, rows);
    store_rows(load_rows(step_, first, rows) + moved, step_, first, rows);
  }
}

// What is left of the step's equation, with the velocities of its own impulses, is solved for again.
void AlartCurnier::correct_step(const SolveState& state) {
  const StepProblem& problem = state.step->problem();
  state.step->velocity(step_, step_velocity_);
  for (std::size_t c = 0; c < step_velocity_.size(); ++c) step_velocity_[c] -= problem.free_velocity[c];
  state.step->jacobian_times(step_velocity_, row_velocity_);
  for (std::size_t b = 0; b < block_first_.size(); ++b) {
    const int first = block_first_[b], rows = block_rows_[b];
    const Vector3d step = load_rows(step_, first, rows), rho = load_rows(rho_, first, rows);
    Vector3d change = load_rows(row_velocity_, first, rows);
    for (int k = 0; k < rows; ++k) change[k] += problem.compliance[first + k] * step[k];
    const Vector3d left =
        load_rows(error_, first, rows) + step + derivative_[b] * (rho.cwiseProduct(change) - step);
    store_rows(left, rest_, first, rows);
  }
  find_step(state);
}

// All of the step, or the first of its halves, quarters, ... whose energy is below the limit, or else all. Returns the energy.
double AlartCurnier::take_step(SolveState& state, double energy_limit) {
  impulse_before_ = state.impulse;
  double whole = 0;
  for (int k = 0; k <= kMostHalvings; ++k) {
    const double length = std::ldexp(1.0, -k);
    for (std::size_t r = 0; r < step_.size(); ++r) state.impulse[r] = impulse_before_[r] + length * step_[r];
    state.update_velocity();
    const double energy = find_error(state);
    if (k == 0) whole = energy;
    if (energy <= (1 - kLeastFall * length) * energy_limit) return energy;
  }
  for (std::size_t r = 0; r < step_.size(); ++r) state.impulse[r] = impulse_before_[r] + step_[r];
  state.update_velocity();
  find_error(state);
  return whole;
}

bool AlartCurnier::attempt(SolveState& state, std::span<const double> start) {
  const int most = kStepsAnIteration * state.options.max_iterations;
  load(state, start);
  energies_.assign(1, find_error(state));
  for (int k = 0; k <= most; ++k) {
    const double residual = state.residual();
    if (residual < best_residual_) best_residual_ = residual, best_impulse_ = state.impulse;
    if (residual <= state.options.target_m_per_s * state.step->velocity_scale()) return true;
    if (k == most || !factor(state)) break;
    ++state.summary->iterations;
    step_.assign(rho_.size(), 0.0);
    rest_ = error_;
    find_step(state);
    for (int c = 0; c < kCorrections; ++c) correct_step(state);
    if (!std::ranges::all_of(step_, [](double x) { return std::isfinite(x); })) break;
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
  choose_rho(state);
  row_velocity_.resize(none.size());
  step_velocity_.resize(state.velocity.size());
  const bool solved = attempt(state, none) || attempt(state, warm_impulse);
  state.load(best_impulse_);
  return solved;
}

}  // namespace cleave
