#include "solver/direct_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/value_spans.h"
#include "solver/attempts.h"
#include "solver/carried_factor.h"
#include "solver/kept_analysis.h"
#include "solver/kernels/kernel.h"
#include "solver/registry.h"

namespace cleave {
namespace {

// What is left may be the rounding of the impulses where it is no more than so many of their last digits.
constexpr double kMostRoundings = 4;

// Where the last digit of the impulses found is a velocity above the limit, and what is left is about that, a
// text that says so. Bodies wedged between others that cannot give way need such impulses; no impulses in
// double precision may then be within the limit. impulse: along the axes of the set.
std::string rounding_note(const PreparedStep& step, std::span<const double> impulse, double residual) {
  double largest = 0;
  for (int r = 0; r < step.row_count(); ++r) {
    largest = std::max(largest, step.diagonal()[r] * std::abs(impulse[r]));
  }
  const double rounding = std::numeric_limits<double>::epsilon() * largest;
  if (!(rounding > step.exact_limit_m_per_s()) || residual > kMostRoundings * rounding) return "";
  std::ostringstream text;
  text << ", which is below the rounding of its impulses, " << rounding << " m/s";
  return text.str();
}

std::unique_ptr<Kernel> make_kernel(const KernelRow& row, const Settings& settings, bool session) {
  std::unique_ptr<Kernel> kernel = row.make(settings);
  if (!session || !kernel->can_be_carried()) return kernel;
  return std::make_unique<CarriedFactor>(std::move(kernel));
}

// No analysis goes on after a solve that ends with an exception.
class BackgroundGuard {
 public:
  explicit BackgroundGuard(ParallelTasks& tasks) : tasks_(tasks) {}
  ~BackgroundGuard() { tasks_.cancel_background(); }
  BackgroundGuard(const BackgroundGuard&) = delete;
  BackgroundGuard& operator=(const BackgroundGuard&) = delete;

 private:
  ParallelTasks& tasks_;
};

class DirectSolver : public StepSolver {
 public:
  DirectSolver(std::string_view strategy, const KernelRow& kernel, const SolveOptions& options,
               const Settings& settings, std::unique_ptr<Strategy> own)
      : strategy_(strategy),
        kernel_name_(kernel.traits.runs_as != nullptr ? kernel.traits.runs_as : kernel.name),
        splits_(kernel.traits.splits),
        clock_(options.threads, options.dispatch, options.models_workers && !options.session),
        kernel_(make_kernel(kernel, settings, options.session)),
        carried_(dynamic_cast<CarriedFactor*>(kernel_.get())),
        state_(read_direct_options(options, settings), clock_),
        attempts_(strategy, settings, std::move(own)) {}

  bool uses_partition() const override { return splits_; }

 private:
  std::string refuse_set(const StepProblem& problem) override;
  SolveSummary do_solve(const StepProblem& problem, const Parts& parts, Solution& solution) override;
  void solve_in_memory(const StepProblem& problem, const Parts& parts, Solution& solution,
                       SolveSummary& summary);
  void prepare(const StepProblem& problem, const Parts& parts);
  void analyze();
  bool run_attempts(SolveSummary& summary);
  void hand_over(Solution& solution);
  void describe_failure(const Solution& solution, SolveSummary& summary);
  void count_work(SolveSummary& summary) const;

  std::string strategy_, kernel_name_;
  bool splits_;
  StageClock clock_;
  std::unique_ptr<Kernel> kernel_;
  CarriedFactor* carried_;  // the same, in a session of a kernel that can; else null
  PreparedStep step_;
  SolveState state_;
  Attempts attempts_;
  KeptAnalysis analysis_;
  Parts planned_parts_;
  std::vector<double> warm_impulse_;  // along the axes of the set
};

std::string DirectSolver::refuse_set(const StepProblem& problem) {
  return find_set_refusal("strategy", strategy_, problem, attempts_.takes());
}

void DirectSolver::analyze() {
  const bool may_keep = state_.options.reuse_analysis || state_.options.session;
  analysis_.analyze(*kernel_, step_, planned_parts_, may_keep, state_.tasks);
}

// The analysis goes on beside what follows, unless it runs tasks of its own. Its function fits into its place
// without memory of its own.
void DirectSolver::prepare(const StepProblem& problem, const Parts& parts) {
  const StageTimer timer(clock_, Stage::analyze);
  planned_parts_ = parts;
  step_.bind(problem, &state_.tasks);
  const bool goes_beside = kernel_->analyzes_as_a_task();
  if (goes_beside) state_.tasks.begin_background([this] { analyze(); });
  step_.compute();
  if (!goes_beside) analyze();
}

// In a session once more where a carried factor has served and the answer is not within the limit.
bool DirectSolver::run_attempts(SolveSummary& summary) {
  if (attempts_.run(step_, *kernel_, warm_impulse_, state_, summary)) return true;
  if (carried_ == nullptr || carried_->counts().factor_reuses == 0) return false;
  ++summary.fallbacks;
  carried_->forget();
  return attempts_.run(step_, *kernel_, warm_impulse_, state_, summary);
}

// What is refused may be so in the middle of a solve: a session analyses when its factor no longer serves.
SolveSummary DirectSolver::do_solve(const StepProblem& problem, const Parts& parts, Solution& solution) {
  SolveSummary summary;
  try {
    solve_in_memory(problem, parts, solution, summary);
  } catch (const MemoryRefused& refused) {
    analysis_.forget();
    summary = {};
    summary.kernel = kernel_name_;
    summary.status = SolveStatus::out_of_memory;
    summary.message = refused.what();
  }
  summary.factor_predicted_mb = 1e-6 * static_cast<double>(state_.tasks.memory().needed_bytes());
  return summary;
}

void DirectSolver::solve_in_memory(const StepProblem& problem, const Parts& parts, Solution& solution,
                                   SolveSummary& summary) {
  summary.kernel = kernel_name_;
  clock_.start();
  state_.last_changed_rows = std::exchange(state_.changed_rows, std::numeric_limits<int>::max());
  if (carried_ != nullptr) carried_->begin_step(state_.last_changed_rows);
  const BackgroundGuard guard(state_.tasks);
  prepare(problem, parts);
  state_.part_of_body = parts.part_of_body;
  warm_impulse_ = solution.impulse;
  step_.set().to_axes(warm_impulse_);
  const bool solved = run_attempts(summary);
  state_.finish_analysis();  // where no strategy came to a factorisation
  hand_over(solution);
  // Strategies that gave up may have come within the limit all the same.
  if (!solved && !(state_.residual() <= step_.exact_limit_m_per_s())) describe_failure(solution, summary);
  count_work(summary);
  summary.times = clock_.stop();
}

void DirectSolver::hand_over(Solution& solution) {
  step_.set().project(state_.impulse);
  solution.impulse = state_.impulse;
  step_.set().to_rows(solution.impulse);
  step_.velocity(solution.impulse, solution.velocity);
}

void DirectSolver::describe_failure(const Solution& solution, SolveSummary& summary) {
  summary.status = SolveStatus::not_converged;
  if (!all_finite(solution.velocity)) summary.status = SolveStatus::diverged;
  summary.message = "strategy " + summary.strategy + " stopped above the limit" +
                    rounding_note(step_, state_.impulse, state_.residual());
}

void DirectSolver::count_work(SolveSummary& summary) const {
  if (carried_ != nullptr) {
    summary.factorizations = carried_->counts().factorizations;
    summary.factor_reuses = carried_->counts().factor_reuses;
    summary.cg_iterations = carried_->counts().cg_iterations;
    summary.factor_mflop_done = carried_->counts().mflop_done;
  }
  summary.interface_unknowns = kernel_->interface_unknowns();
  summary.factor_mflop_local = kernel_->local_mflop();
  summary.factor_mflop_interface = kernel_->interface_mflop();
}

}  // namespace

std::unique_ptr<StepSolver> make_direct_solver(std::string_view strategy, std::string_view kernel,
                                               const SolveOptions& options, const Settings& settings,
                                               std::unique_ptr<Strategy> own) {
  const StrategyRow* strategy_row = find_row(strategy_table(), strategy);
  const KernelRow* kernel_row = find_row(kernel_table(), kernel);
  if (strategy_row == nullptr || kernel_row == nullptr || !runs_on(*strategy_row, *kernel_row))
    return nullptr;
  return std::make_unique<DirectSolver>(strategy_row->name, *kernel_row, options, settings, std::move(own));
}

}  // namespace cleave
