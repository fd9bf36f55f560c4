// Solver `apgd`: accelerated projected gradient descent on
//
//     f(lambda) = 1/2 lambda^T A lambda + lambda^T (J v0 - b),   A = J M^-1 J^T + C,   lo <= lambda <= hi,
//
// whose gradient is the slack w = J v + C lambda - b; A is never formed. In units in which its diagonal is 1,
// that is with lengths |x|^2 = sum d_r x_r^2, one iteration from lambda_k and the extrapolated y_k (slack
// w_y) is
//
//     lambda_k+1 = clamp(y_k - w_y / (L d)),    L doubled while, with s = lambda_k+1 - y_k, s^T A s > L |s|^2
//     theta_k+1^2 = (1 - theta_k+1) theta_k^2,  beta = theta_k (1 - theta_k) / (theta_k^2 + theta_k+1)
//     y_k+1 = lambda_k+1 + beta (lambda_k+1 - lambda_k)
//     where w_y^T (lambda_k+1 - lambda_k) > 0: y_k+1 = lambda_k+1, theta_k+1 = 1;    then L <- 0.9 L
//
// and the iterate of the least residual is the result. It ends after `sweeps` iterations, or where the
// residual is at most the solver's target or `until`. An iteration costs one product with J and one with M^-1
// J^T, and both again for every doubling.
//
// Source: Mazhar, Heyn, Negrut and Tasora, Using Nesterov's method to accelerate multibody dynamics with
// friction and contact, ACM Transactions on Graphics 34(3), 2015, algorithm 1, on the sequence of Nesterov
// 1983 with the restart of O'Donoghue and Candes 2015, section 3.2. What differs: boxes in place of cones,
// units with diagonal 1, a warm start, the judge's residual in place of theirs, and L ends at a bound that
// needs no test: with at most N rows on a body, x^T A x <= N |x|^2 (Cauchy and Schwarz, as in split_sweep.h).
// Rounding could double it for ever.
#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/base/larger_or_nan.h"
#include "solver/baselines/baselines.h"
#include "solver/baselines/iterative_baseline.h"

namespace cleave {
namespace {

struct Point {
  std::vector<double> impulse, slack;  // (m)
};

class Apgd : public IterativeBaseline {
 public:
  Apgd(const SolveOptions& options, const Settings& settings)
      : IterativeBaseline("apgd", options),
        sweeps_(settings.integer("sweeps")),
        target_m_per_s_(std::max(options.target_m_per_s, settings.number("until"))) {}

 private:
  int iterate(const PreparedStep& step, Solution& solution) override;
  void start(const PreparedStep& step, Solution& solution);
  double first_curvature(const PreparedStep& step, std::span<double> v);
  void descend(const PreparedStep& step, std::span<double> v);
  double move(const PreparedStep& step);
  double curvature_of_move(const PreparedStep& step);
  double slope_of_progress(const PreparedStep& step);
  void extrapolate(const PreparedStep& step, double beta);
  double residual(const PreparedStep& step, const Point& point);
  void keep_if_best(const PreparedStep& step, const Point& point);

  template <class Value>
  void over_rows(const PreparedStep& step, const Value& value_of);
  template <class Value>
  double sum(const PreparedStep& step, const Value& value_of);

  int sweeps_;
  double target_m_per_s_;
  Point last_, next_, y_;                                                       // lambda_k, lambda_k+1, y_k
  double theta_ = 1, curvature_ = 1, most_curvature_ = 1, least_residual_ = 0;  // curvature: L
  std::vector<double> best_;                                                    // (m)
  std::vector<double> chunk_values_;
};

int most_rows_of_a_body(const PreparedStep& step) {
  int most = 1;
  for (int body = 0; body < step.body_count(); ++body) {
    int rows = 0;
    for (const int side : step.sides_of_body(body)) rows += step.groups()[side / 2].row_count;
    most = std::max(most, rows);
  }
  return most;
}

void evaluate(const PreparedStep& step, std::span<double> v, Point& point) {
  step.velocity(point.impulse, v);
  step.slack(v, point.impulse, point.slack);
}

int Apgd::iterate(const PreparedStep& step, Solution& solution) {
  if (step.row_count() == 0) return 0;
  start(step, solution);
  int done = 0;
  for (; done < sweeps_ && least_residual_ > target_m_per_s_ * step.velocity_scale(); ++done) {
    check_stop(stop());
    descend(step, solution.velocity);
    keep_if_best(step, next_);
    const double old = theta_ * theta_;
    theta_ = (std::sqrt(old * old + 4 * old) - old) / 2;
    if (slope_of_progress(step) > 0) {
      theta_ = 1;
      extrapolate(step, 0);
    } else {
      extrapolate(step, std::sqrt(old) * (1 - std::sqrt(old)) / (old + theta_));
    }
    std::swap(last_, next_);
    curvature_ *= 0.9;
  }
  solution.impulse = best_;
  return done;
}

void Apgd::start(const PreparedStep& step, Solution& solution) {
  check_stop(stop());
  for (Point* point : {&last_, &next_, &y_}) {
    point->impulse = solution.impulse;
    point->slack.resize(step.row_count());
  }
  step.set().project(last_.impulse);
  evaluate(step, solution.velocity, last_);
  most_curvature_ = most_rows_of_a_body(step);
  curvature_ = first_curvature(step, solution.velocity);
  y_.impulse = last_.impulse;
  y_.slack = last_.slack;
  theta_ = 1;
  least_residual_ = std::numeric_limits<double>::infinity();
  best_ = last_.impulse;
  keep_if_best(step, last_);
}

// |A x| / |x| along the vector of ones of the units with diagonal 1; A's greatest eigenvalue is at least 1
// there.
double Apgd::first_curvature(const PreparedStep& step, std::span<double> v) {
  for (int r = 0; r < step.row_count(); ++r)
    next_.impulse[r] = last_.impulse[r] + 1 / std::sqrt(step.diagonal()[r]);
  evaluate(step, v, next_);
  const double squares = sum(step, [&](int r) {
    const double change = next_.slack[r] - last_.slack[r];
    return change * change / step.diagonal()[r];
  });
  return std::clamp(std::sqrt(squares / step.row_count()), 1.0, most_curvature_);
}

// lambda_k+1 from y_k, L doubled until it suits. An L that is no number ends it too: the residual tells.
void Apgd::descend(const PreparedStep& step, std::span<double> v) {
  while (true) {
    check_stop(stop());
    const double length = move(step);
    evaluate(step, v, next_);
    if (!(curvature_ < most_curvature_) || curvature_of_move(step) <= curvature_ * length) return;
    curvature_ = std::min(2 * curvature_, most_curvature_);
  }
}

// lambda_k+1 for the L at hand; |lambda_k+1 - y_k|^2.
double Apgd::move(const PreparedStep& step) {
  const StepProblem& problem = step.problem();
  return sum(step, [&](int r) {
    const double d = step.diagonal()[r];
    next_.impulse[r] =
        std::clamp(y_.impulse[r] - y_.slack[r] / (curvature_ * d), problem.lower[r], problem.upper[r]);
    const double moved = next_.impulse[r] - y_.impulse[r];
    return d * moved * moved;
  });
}

double Apgd::curvature_of_move(const PreparedStep& step) {
  return sum(step,
             [&](int r) { return (next_.impulse[r] - y_.impulse[r]) * (next_.slack[r] - y_.slack[r]); });
}

double Apgd::slope_of_progress(const PreparedStep& step) {
  return sum(step, [&](int r) { return y_.slack[r] * (next_.impulse[r] - last_.impulse[r]); });
}

// Slacks are affine in the impulses, so that of y needs no product.
void Apgd::extrapolate(const PreparedStep& step, double beta) {
  over_rows(step, [&](int first, int last, double&) {
    for (int r = first; r < last; ++r) {
      y_.impulse[r] = next_.impulse[r] + beta * (next_.impulse[r] - last_.impulse[r]);
      y_.slack[r] = next_.slack[r] + beta * (next_.slack[r] - last_.slack[r]);
    }
  });
}

double Apgd::residual(const PreparedStep& step, const Point& point) {
  over_rows(step, [&](int first, int last, double& greatest) {
    greatest = step.set().residual(first, last, step.diagonal(), point.impulse, point.slack);
  });
  double greatest = 0;
  for (const double value : chunk_values_) greatest = larger_or_infinite(greatest, value);
  return greatest;
}

void Apgd::keep_if_best(const PreparedStep& step, const Point& point) {
  const double found = residual(step, point);
  if (!(found < least_residual_)) return;
  least_residual_ = found;
  best_ = point.impulse;
}

// value_of(first row, last row, value of the chunk), into chunk_values_.
template <class Value>
void Apgd::over_rows(const PreparedStep& step, const Value& value_of) {
  chunk_values_.assign(step.group_chunks().size(), 0.0);
  tasks().run(static_cast<int>(chunk_values_.size()), [&](int chunk) {
    const auto [first, last] = step.rows_of(step.group_chunks()[chunk]);
    value_of(first, last, chunk_values_[chunk]);
  });
}

// Of a number a row: in the order of rows within a chunk, then of chunks.
template <class Value>
double Apgd::sum(const PreparedStep& step, const Value& value_of) {
  over_rows(step, [&](int first, int last, double& total) {
    for (int r = first; r < last; ++r) total += value_of(r);
  });
  double total = 0;
  for (const double value : chunk_values_) total += value;
  return total;
}

}  // namespace

std::unique_ptr<StepSolver> make_apgd(const SolveOptions& options, const Settings& settings) {
  return std::make_unique<Apgd>(options, settings);
}

}  // namespace cleave
