#include "solver/direct_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "solver/carried_factor.h"
#include "solver/kernels/kernel.h"
#include "solver/proximal_step.h"
#include "solver/registry.h"
#include "solver/strategies/automatic.h"
#include "solver/strategies/strategy.h"

namespace cleave {
namespace {

constexpr double kProximalDeltas[] = {0, 1e-9, 1e-11};  // tried in this order; 0 is the problem as it is
constexpr int kMostProximalSteps = 50;
constexpr int kStalledProximalSteps = 8;  // without the residual falling by a tenth, before giving up

// The impulses of the least residual among those offered.
struct Best {
  double residual = std::numeric_limits<double>::infinity();
  std::vector<double> impulse;

  void clear() { residual = std::numeric_limits<double>::infinity(); }
  void offer(SolveState& state) {
    const double offered = state.residual();
    if (offered < residual) residual = offered, impulse = state.impulse;
  }
  void restore(SolveState& state) const {
    if (std::isfinite(residual)) state.impulse = impulse;
    state.update_velocity();
  }
};

// Where the limit cannot be met by any impulses in double precision, a text that says so: their last digit is
// a velocity above it. Bodies wedged between others that cannot give way need such impulses.
// impulse: along the axes of the set.
std::string rounding_note(const PreparedStep& step, std::span<const double> impulse) {
  double largest = 0;
  for (int r = 0; r < step.row_count(); ++r) {
    largest = std::max(largest, step.diagonal()[r] * std::abs(impulse[r]));
  }
  const double rounding = std::numeric_limits<double>::epsilon() * largest;
  if (!(rounding > step.exact_limit_m_per_s())) return "";
  std::ostringstream text;
  text << ", which is below the rounding of its impulses, " << rounding << " m/s";
  return text.str();
}

std::unique_ptr<Kernel> make_kernel(const KernelRow& row, const Settings& settings, bool session) {
  std::unique_ptr<Kernel> kernel = row.make(settings);
  if (!session || !kernel->can_be_carried()) return kernel;
  return std::make_unique<CarriedFactor>(std::move(kernel));
}

struct Link {
  std::string_view name;
  std::unique_ptr<Strategy> strategy;
};

class DirectSolver : public StepSolver {
 public:
  DirectSolver(std::string_view strategy, const KernelRow& kernel, const SolveOptions& options,
               const Settings& settings, std::unique_ptr<Strategy> own)
      : strategy_(strategy),
        kernel_name_(kernel.resolved),
        splits_(kernel.splits),
        settings_(settings),
        clock_(options.threads, options.dispatch, !options.session),
        kernel_(make_kernel(kernel, settings, options.session)),
        carried_(dynamic_cast<CarriedFactor*>(kernel_.get())),
        state_(read_direct_options(options, settings), clock_) {
    if (own != nullptr) links_.push_back({strategy, std::move(own)});
  }

  bool uses_partition() const override { return splits_; }

 private:
  std::string refuse_set(const StepProblem& problem) override;
  SolveSummary do_solve(const StepProblem& problem, const Parts& parts, Solution& solution) override;
  void solve_in_memory(const StepProblem& problem, const Parts& parts, Solution& solution,
                       SolveSummary& summary);
  void plan_analysis(const StepProblem& problem, const Parts& parts);
  void analyze(const StepProblem& problem, const Parts& parts);
  bool attempt(SolveSummary& summary, double delta, std::span<const double> warm_impulse);
  bool run_attempts(SolveSummary& summary, const StepProblem& problem, std::span<const double> warm_impulse);
  bool reuse_analysis(const StepProblem& problem, const Parts& parts);
  bool run_chain(SolveSummary& summary, std::span<const double> warm_impulse);
  bool run_proximal(SolveSummary& summary);
  Strategy& strategy(std::string_view name);

  std::string strategy_, kernel_name_;
  bool splits_;
  Settings settings_;
  StageClock clock_;
  std::unique_ptr<Kernel> kernel_;
  CarriedFactor* carried_;  // the same, in a session of a kernel that can; else null
  PreparedStep step_;
  SolveState state_;
  std::vector<Link> links_;  // strategies made so far
  const StepProblem* planned_problem_ = nullptr;
  Parts planned_parts_;
  bool analyzed_ = false;
  int analyzed_bodies_ = 0;
  std::vector<int> analyzed_body_;
  std::vector<int> analyzed_part_, analyzed_parent_;  // what the kernel looks at, until it is given others
  std::vector<double> warm_impulse_;                  // along the axes of the set
  ProximalStep proximal_;
  Best chain_best_, proximal_best_, attempt_best_;
};

Strategy& DirectSolver::strategy(std::string_view name) {
  for (Link& link : links_) {
    if (link.name == name) return *link.strategy;
  }
  for (const StrategyRow& row : strategy_table()) {
    if (row.name == name && row.make != nullptr) {
      links_.push_back({row.name, row.make(settings_)});
      return *links_.back().strategy;
    }
  }
  throw std::logic_error("no strategy of this name: " + std::string(name));
}

// auto picks the interior point where a set is no interval; a named strategy must take it from its first link on.
std::string DirectSolver::refuse_set(const StepProblem& problem) {
  const SetKind taken = strategy(strategy_ == "auto" ? "interior-point" : strategy_).takes();
  return find_set_refusal("strategy", strategy_, problem, taken);
}

// Rows between the same bodies, or at least between pairs that the analysed pattern has a place for.
bool DirectSolver::reuse_analysis(const StepProblem& problem, const Parts& parts) {
  if (problem.body_count() != analyzed_bodies_) return false;
  if (!std::ranges::equal(parts.part_of_body, analyzed_part_)) return false;
  if (!std::ranges::equal(parts.parent_of_part, analyzed_parent_)) return false;
  return problem.row_body == analyzed_body_ ||
         kernel_->rebind(step_, Parts(analyzed_part_, analyzed_parent_), state_.tasks);
}

void DirectSolver::analyze(const StepProblem& problem, const Parts& parts) {
  // Not analysed until all of it is done: there may be no memory half-way.
  const bool analyzed = std::exchange(analyzed_, false);
  const bool may_reuse = state_.options.reuse_analysis || state_.options.session;
  const bool reused = analyzed && may_reuse && reuse_analysis(problem, parts);
  {
    StageTimer timer(clock_, Stage::analyze);
    analyzed_bodies_ = problem.body_count();
    analyzed_body_ = problem.row_body;
    analyzed_part_.assign(parts.part_of_body.begin(), parts.part_of_body.end());
    analyzed_parent_.assign(parts.parent_of_part.begin(), parts.parent_of_part.end());
  }
  if (!reused) kernel_->analyze(step_, Parts(analyzed_part_, analyzed_parent_), state_.tasks);
  analyzed_ = true;
}

// At once where it runs tasks of its own, else when a strategy has time for it. What the plan holds fits into the
// function without memory of its own.
void DirectSolver::plan_analysis(const StepProblem& problem, const Parts& parts) {
  planned_problem_ = &problem;
  planned_parts_ = parts;
  state_.analysis = [this] { analyze(*planned_problem_, planned_parts_); };
  if (!kernel_->analyzes_as_a_task()) state_.analyze();
}

// Runs the strategies one after the other until one succeeds; each hand-over is counted. When all fail, the
// impulses of the least residual stay.
bool DirectSolver::run_chain(SolveSummary& summary, std::span<const double> warm_impulse) {
  const StrategyChoice choice = choose_strategies(strategy_, state_);
  summary.auto_reason = choice.reason;
  chain_best_.clear();
  for (int k = 0; k < choice.count; ++k) {
    if (k > 0) {
      ++summary.fallbacks;
      if (strategy_ == "auto") summary.auto_reason += ", " + std::string(choice.names[k - 1]) + " stalled";
      state_.begin(step_, *state_.kernel, summary, warm_impulse);  // not from where the last one got lost
    }
    summary.strategy = choice.names[k];
    if (strategy(choice.names[k]).run(state_)) return true;
    state_.update_velocity();
    chain_best_.offer(state_);
  }
  chain_best_.restore(state_);
  return false;
}

// Proximal steps (proximal_step.h) until the residual of the problem as it was asked, compliance zero, is at
// the target or falls no more. Between them the active set mostly stays: then a step is a correction by the
// factor at hand.
bool DirectSolver::run_proximal(SolveSummary& summary) {
  const double target = state_.options.target_m_per_s * step_.velocity_scale();
  proximal_best_.clear();
  if (!state_.factor_free()) return false;
  for (int k = 0, stalled = 0; k < kMostProximalSteps && stalled < kStalledProximalSteps; ++k) {
    proximal_.recentre(state_.impulse);
    state_.update_velocity();
    const double residual = state_.residual();
    if (residual <= target) return true;
    stalled = residual < 0.9 * proximal_best_.residual ? 0 : stalled + 1;
    proximal_best_.offer(state_);
    ++summary.refinements;
    state_.refine_free(0.1 * target, 3, false);
    if (state_.find_violations(0.1 * target) == 0 || state_.settle(0.1 * target)) continue;
    state_.begin(step_, *kernel_, summary, proximal_best_.impulse);
    if (!run_chain(summary, proximal_best_.impulse)) break;
  }
  proximal_best_.restore(state_);
  return proximal_best_.residual <= step_.exact_limit_m_per_s();
}

// One run of the strategies, on the problem itself (delta 0) or by proximal steps. The impulses that stay are
// the best that were seen.
bool DirectSolver::attempt(SolveSummary& summary, double delta, std::span<const double> warm_impulse) {
  {
    StageTimer timer(clock_, Stage::predict);
    if (delta > 0) {
      proximal_.begin(step_, warm_impulse, delta);
      step_.prepare(proximal_.problem(), &state_.tasks);
    }
    state_.begin(step_, *kernel_, summary, warm_impulse);
  }
  return run_chain(summary, warm_impulse) && (delta == 0 || run_proximal(summary));
}

// The problem itself; then proximal steps where compliance is so small, or zero, that rounding kept the first
// attempt above the limit. Those stand on an active set, which cones have not; the interior point's own delta serves them.
bool DirectSolver::run_attempts(SolveSummary& summary, const StepProblem& problem,
                                std::span<const double> warm_impulse) {
  const double stiffest = step_.least_relative_compliance();
  const bool has_cones = !step_.set().cones().empty();
  attempt_best_.clear();
  int attempts = 0;
  for (double delta : kProximalDeltas) {
    if (delta > 0 && (stiffest >= delta || has_cones)) continue;
    if (attempts++ > 0) ++summary.fallbacks;
    if (attempt(summary, delta, warm_impulse)) return true;
    if (delta > 0) step_.prepare(problem, &state_.tasks);
    state_.update_velocity();
    attempt_best_.offer(state_);
  }
  attempt_best_.restore(state_);
  return false;
}

// What is refused may be so in the middle of a solve: a session analyses when its factor no longer serves.
SolveSummary DirectSolver::do_solve(const StepProblem& problem, const Parts& parts, Solution& solution) {
  SolveSummary summary;
  try {
    solve_in_memory(problem, parts, solution, summary);
  } catch (const MemoryRefused& refused) {
    analyzed_ = false;
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
  {
    StageTimer timer(clock_, Stage::analyze);
    step_.prepare(problem, &state_.tasks);
  }
  if (carried_ != nullptr) carried_->begin_step(state_.changed_rows);
  plan_analysis(problem, parts);
  state_.part_of_body = parts.part_of_body;
  warm_impulse_ = solution.impulse;
  step_.set().to_axes(warm_impulse_);
  bool solved = run_attempts(summary, problem, warm_impulse_);
  if (!solved && carried_ != nullptr && carried_->counts().factor_reuses > 0) {
    ++summary.fallbacks;
    carried_->forget();
    solved = run_attempts(summary, problem, warm_impulse_);
  }
  state_.analyze();  // where no strategy came to a factorisation
  step_.set().project(state_.impulse);
  solution.impulse = state_.impulse;
  step_.set().to_rows(solution.impulse);
  step_.velocity(solution.impulse, solution.velocity);
  if (!solved) {
    summary.status = SolveStatus::not_converged;
    summary.message =
        "strategy " + summary.strategy + " stopped above the limit" + rounding_note(step_, state_.impulse);
    for (double v : solution.velocity) {
      if (!std::isfinite(v)) summary.status = SolveStatus::diverged;
    }
  }
  if (carried_ != nullptr) {
    summary.factorizations = carried_->counts().factorizations;
    summary.factor_reuses = carried_->counts().factor_reuses;
    summary.cg_iterations = carried_->counts().cg_iterations;
    summary.factor_mflop_done = carried_->counts().mflop_done;
  }
  summary.interface_unknowns = kernel_->interface_unknowns();
  summary.factor_mflop_local = kernel_->local_mflop();
  summary.factor_mflop_interface = kernel_->interface_mflop();
  summary.times = clock_.stop();
}

}  // namespace

std::unique_ptr<StepSolver> make_direct_solver(std::string_view strategy, std::string_view kernel,
                                               const SolveOptions& options, const Settings& settings,
                                               std::unique_ptr<Strategy> own) {
  const auto name_of = [](const AlgorithmEntry& row) { return std::string_view(row.name); };
  const auto strategy_row = std::ranges::find(strategy_table(), strategy, name_of);
  const auto kernel_row = std::ranges::find(kernel_table(), kernel, name_of);
  if (strategy_row == strategy_table().end() || kernel_row == kernel_table().end()) return nullptr;
  if (!runs_on(*strategy_row, *kernel_row)) return nullptr;
  return std::make_unique<DirectSolver>(strategy_row->name, *kernel_row, options, settings, std::move(own));
}

}  // namespace cleave
