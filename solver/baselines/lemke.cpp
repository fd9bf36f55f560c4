// Solver `lemke`: the step problem as a linear complementarity problem (LCP), solved by Lemke's pivots
// (lemke_tableau.h) on dense matrices. With A = J M^-1 J^T + C and q = J v0 - b, in units in which A has
// diagonal 1 (y_r = sqrt(d_r) lambda_r, w_r / sqrt(d_r)):
//
//     rows with lo = hi                 y = lo, no unknown
//     rows without bounds, F            eliminated by Schur complement: S = A_BB - A_BF A_FF^-1 A_FB. Largest
//                                       pivot first; rows that then have none left depend on others (C = 0)
//                                       and take no impulse of their own
//     rows with a lower bound           z = y - lo >= 0
//     with an upper bound alone         z = hi - y >= 0, the row turned round
//     with both, z <= u = hi - lo       a pair more, multiplier mu of the slack s:
//
//                                           | w |   |  S  I | | z  |   | q |     all >= 0,
//                                           | s | = | -I  0 | | mu | + | u |     w^T z = 0,  s^T mu = 0
//
// The final basis says which rows are free and which at which bound. The free ones, F among them, are then
// solved once more from the step itself, with refinement on its slack: pivots leave their rounding behind.
// The warm start is not used: Lemke has to begin where it begins. A ray, or the limit of pivots, ends with
// what the basis at hand gives, and says so.
//
// Source: Lemke 1965; Cottle, Pang and Stone 1992, section 4.4; Murty 1988, chapter 2. The box as slack pairs
// is common.
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "solver/baselines/baselines.h"
#include "solver/baselines/lemke_tableau.h"
#include "solver/linear/eigen_blocking.h"
#include "solver/memory_count.h"
#include "solver/prepared_step.h"
#include "solver/solve_state.h"
#include "solver/stage_clock.h"

namespace cleave {
namespace {

constexpr int kMostPivotsPerUnknown = 50;
constexpr double kDependent = 1e-11;  // a pivot of a row without bounds below this is rounding of zero
constexpr double kShift = 1e-12;      // on the diagonal of the last solve, so that redundant rows have one
constexpr int kMostRefinements = 50;

class Lemke : public StepSolver {
 public:
  Lemke(const SolveOptions& options, int most_rows)
      : options_(options),
        clock_(options.threads, options.dispatch, options.models_workers),
        most_rows_(most_rows) {}
  bool uses_partition() const override { return false; }

 private:
  std::string refuse_set(const StepProblem& problem) override {
    return find_set_refusal("solver", "lemke", problem);
  }
  SolveSummary do_solve(const StepProblem& problem, const Parts& parts, Solution& solution) override;
  void list_rows();
  void solve_in_memory(const StepProblem& problem, Solution& solution, SolveSummary& summary);
  void request_memory(SolveSummary& summary) const;
  void assemble();
  void eliminate_unbounded();
  void fill_tableau();
  void read_states();
  void set_impulses(std::span<double> impulse) const;
  void update(Solution& solution);
  void solve_free(SolveSummary& summary, Solution& solution);
  std::string reason(LemkeTableau::End end, double residual) const;

  SolveOptions options_;
  StageClock clock_;
  int most_rows_;
  PreparedStep step_;
  Eigen::VectorXd unit_;              // (m) 1 / sqrt(d_r)
  Eigen::VectorXd start_;             // (m) y of z = 0
  Eigen::VectorXd sign_;              // (m) -1 on rows turned round
  std::vector<RowState> state_;       // (m) held where lo = hi
  std::vector<int> bounded_, pairs_;  // rows of z; places in bounded_ of those with both bounds
  std::vector<int> unbounded_;
  Eigen::MatrixXd a_, reduced_;  // (m, m); reduced: with S on the bounded rows
  Eigen::VectorXd q_;            // (m) at the start
  LemkeTableau tableau_;
  std::vector<double> slack_;
};

SolveSummary Lemke::do_solve(const StepProblem& problem, const Parts&, Solution& solution) {
  SolveSummary summary;
  summary.strategy = "lemke";
  summary.kernel = "-";
  check_stop(options_.stop);
  if (problem.row_count() > most_rows_) {
    summary.status = SolveStatus::refused;
    summary.message =
        std::to_string(problem.row_count()) + " rows, more than lemke-max-rows " + std::to_string(most_rows_);
    return summary;
  }
  try {
    solve_in_memory(problem, solution, summary);
  } catch (const MemoryRefused& refused) {
    summary.status = SolveStatus::out_of_memory;
    summary.message = refused.what();
  }
  return summary;
}

void Lemke::solve_in_memory(const StepProblem& problem, Solution& solution, SolveSummary& summary) {
  clock_.start();
  {
    StageTimer timer(clock_, Stage::assemble);
    step_.prepare(problem);
    list_rows();
    request_memory(summary);
    assemble();
    eliminate_unbounded();
    fill_tableau();
  }
  LemkeTableau::End end;
  {
    StageTimer timer(clock_, Stage::solve);
    const int unknowns = static_cast<int>(bounded_.size() + pairs_.size());
    end = tableau_.solve(kMostPivotsPerUnknown * unknowns, options_.stop);
    summary.iterations = tableau_.pivots();
  }
  {
    StageTimer timer(clock_, Stage::refine);
    read_states();
    set_impulses(solution.impulse);
    solve_free(summary, solution);
    step_.set().project(solution.impulse);
    update(solution);
  }
  const double residual = step_.residual(solution.impulse, slack_);
  if (!(residual <= step_.exact_limit_m_per_s())) {
    summary.status = SolveStatus::not_converged;
    summary.message = reason(end, residual);
  }
  summary.times = clock_.stop();
}

void Lemke::list_rows() {
  const StepProblem& problem = step_.problem();
  const int m = step_.row_count();
  unit_ = Eigen::Map<const Eigen::VectorXd>(step_.diagonal().data(), m).cwiseSqrt().cwiseInverse();
  start_.setZero(m);
  sign_.setOnes(m);
  state_.assign(m, RowState::free);
  bounded_.clear();
  pairs_.clear();
  unbounded_.clear();
  for (int r = 0; r < m; ++r) {
    const bool has_lower = std::isfinite(problem.lower[r]), has_upper = std::isfinite(problem.upper[r]);
    if (has_lower || has_upper) start_[r] = (has_lower ? problem.lower[r] : problem.upper[r]) / unit_[r];
    if (problem.lower[r] == problem.upper[r]) {
      state_[r] = RowState::held;
    } else if (!has_lower && !has_upper) {
      unbounded_.push_back(r);
    } else {
      if (!has_lower) sign_[r] = -1;
      if (has_lower && has_upper) pairs_.push_back(static_cast<int>(bounded_.size()));
      bounded_.push_back(r);
    }
  }
}

void Lemke::request_memory(SolveSummary& summary) const {
  const auto m = static_cast<std::uint64_t>(step_.row_count());
  MemoryCount memory;
  memory.add<double>(4 * m, m);  // A, S, and what the last solve factors, twice
  memory.add<double>(LemkeTableau::size_of(bounded_.size() + pairs_.size()));
  summary.factor_predicted_mb = 1e-6 * static_cast<double>(memory.bytes());
  MemoryBudget(options_.memory_limit_bytes).request(memory);
}

// A body adds to the entries of all pairs of rows that it is in.
void Lemke::assemble() {
  const StepProblem& problem = step_.problem();
  const int m = step_.row_count();
  a_.setZero(m, m);
  for (int body = 0; body < step_.body_count(); ++body) {
    for (const int side : step_.sides_of_body(body)) {
      for (const int other : step_.sides_of_body(body)) {
        const RowGroup &g = step_.groups()[side / 2], &h = step_.groups()[other / 2];
        for (int i = g.first_row; i < g.first_row + g.row_count; ++i)
          for (int j = h.first_row; j < h.first_row + h.row_count; ++j)
            for (int c = 0; c < 6; ++c)
              a_(i, j) += problem.jacobian[12L * i + 6 * (side % 2) + c] *
                          step_.mass_jacobian()[12L * j + 6 * (other % 2) + c];
      }
    }
  }
  for (int r = 0; r < m; ++r) a_(r, r) += problem.compliance[r];
  a_ = unit_.asDiagonal() * a_ * unit_.asDiagonal();
  slack_.assign(m, 0.0);
  const std::vector<double> none(m, 0.0);
  step_.slack(problem.free_velocity, none, slack_);
  q_ = unit_.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(slack_.data(), m)) + a_ * start_;
}

// Symmetric Gaussian elimination, which leaves S and its q on the other rows.
void Lemke::eliminate_unbounded() {
  reduced_ = a_;
  std::vector<int> left = unbounded_;
  std::vector<int> others = bounded_;
  others.insert(others.end(), unbounded_.begin(), unbounded_.end());
  while (!left.empty()) {
    const auto most = std::ranges::max_element(left, {}, [this](int r) { return reduced_(r, r); });
    const int p = *most;
    if (!(reduced_(p, p) > kDependent)) return;
    left.erase(most);
    std::erase(others, p);
    for (const int j : others) {
      const double factor = reduced_(p, j) / reduced_(p, p);
      for (const int i : others) reduced_(i, j) -= reduced_(i, p) * factor;
    }
    for (const int i : others) q_[i] -= reduced_(i, p) / reduced_(p, p) * q_[p];
  }
}

void Lemke::fill_tableau() {
  const StepProblem& problem = step_.problem();
  const int rows = static_cast<int>(bounded_.size());
  tableau_.resize(rows + static_cast<int>(pairs_.size()));
  for (int i = 0; i < rows; ++i) {
    const int r = bounded_[i];
    tableau_.set_constant(i, sign_[r] * q_[r]);
    for (int j = 0; j < rows; ++j)
      tableau_.set_matrix(i, j, sign_[r] * sign_[bounded_[j]] * reduced_(r, bounded_[j]));
  }
  for (int k = 0; k < static_cast<int>(pairs_.size()); ++k) {
    const int i = pairs_[k], r = bounded_[i];
    tableau_.set_constant(rows + k, (problem.upper[r] - problem.lower[r]) / unit_[r]);
    tableau_.set_matrix(i, rows + k, 1);
    tableau_.set_matrix(rows + k, i, -1);
  }
}

void Lemke::read_states() {
  for (std::size_t i = 0; i < bounded_.size(); ++i) {
    if (tableau_.is_basic(static_cast<int>(i))) continue;
    state_[bounded_[i]] = sign_[bounded_[i]] > 0 ? RowState::lower : RowState::upper;
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (tableau_.is_basic(static_cast<int>(bounded_.size() + k)))
      state_[bounded_[pairs_[k]]] = RowState::upper;
}

// Impulses at their bounds where the basis has them there, those of the other rows from the tableau.
void Lemke::set_impulses(std::span<double> impulse) const {
  const StepProblem& problem = step_.problem();
  for (const int r : unbounded_) impulse[r] = 0;
  for (int r = 0; r < step_.row_count(); ++r) {
    if (state_[r] != RowState::free)
      impulse[r] = state_[r] == RowState::upper ? problem.upper[r] : problem.lower[r];
  }
  for (std::size_t i = 0; i < bounded_.size(); ++i) {
    const int r = bounded_[i];
    if (state_[r] == RowState::free)
      impulse[r] = unit_[r] * (start_[r] + sign_[r] * tableau_.value(static_cast<int>(i)));
  }
}

void Lemke::update(Solution& solution) {
  step_.velocity(solution.impulse, solution.velocity);
  step_.slack(solution.velocity, solution.impulse, slack_);
}

// The impulses of the free rows so that their slack is zero, by increments until it is: where they reach
// rounding, which lets it rise and fall, the best of all stay.
void Lemke::solve_free(SolveSummary& summary, Solution& solution) {
  std::vector<int> free;
  for (int r = 0; r < step_.row_count(); ++r)
    if (state_[r] == RowState::free) free.push_back(r);
  Eigen::MatrixXd of_free = a_(free, free);
  of_free.diagonal().array() += kShift;
  const Eigen::LDLT<Eigen::MatrixXd> factor(of_free);
  summary.factorizations = 1;
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> best = solution.impulse;
  for (int k = 0; k <= kMostRefinements; ++k) {
    update(solution);
    const Eigen::VectorXd w = Eigen::Map<const Eigen::VectorXd>(slack_.data(), step_.row_count())(free);
    const double largest = free.empty() ? 0 : w.cwiseAbs().maxCoeff();
    if (largest < least) least = largest, best = solution.impulse, summary.refinements = k;
    if (!(largest > options_.target_m_per_s)) break;
    const Eigen::VectorXd change = factor.solve(Eigen::VectorXd(unit_(free)).cwiseProduct(w));
    for (std::size_t i = 0; i < free.size(); ++i) solution.impulse[free[i]] -= unit_[free[i]] * change[i];
  }
  solution.impulse = best;
}

std::string Lemke::reason(LemkeTableau::End end, double residual) const {
  std::ostringstream text;
  switch (end) {
    case LemkeTableau::End::ray:
      text << "a ray after " << tableau_.pivots()
           << " pivots: no impulses satisfy all rows at once, as far as rounding lets one tell";
      break;
    case LemkeTableau::End::pivot_limit:
      text << "no end after " << tableau_.pivots() << " pivots";
      break;
    case LemkeTableau::End::solved:
      text << "residual " << residual << " m/s above the limit after " << tableau_.pivots() << " pivots";
  }
  return text.str();
}

}  // namespace

std::unique_ptr<StepSolver> make_lemke(const SolveOptions& options, const Settings& settings) {
  fix_eigen_blocking();
  return std::make_unique<Lemke>(options, settings.integer("lemke-max-rows"));
}

}  // namespace cleave
