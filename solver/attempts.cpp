#include "solver/attempts.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "solver/registry.h"
#include "solver/strategies/automatic.h"

namespace cleave {
namespace {

constexpr double kProximalDeltas[] = {0, 1e-9, 1e-11};  // tried in this order; 0 is the problem as it is
constexpr int kMostProximalSteps = 50;
constexpr int kStalledProximalSteps = 8;  // without the residual falling by a tenth, before giving up

}  // namespace

void Attempts::Best::offer(SolveState& state) {
  const double offered = state.residual();
  if (offered < residual) residual = offered, impulse = state.impulse;
}

void Attempts::Best::restore(SolveState& state) const {
  if (std::isfinite(residual)) state.impulse = impulse;
  state.update_velocity();
}

Attempts::Attempts(std::string_view strategy, const Settings& settings, std::unique_ptr<Strategy> own)
    : strategy_(strategy), settings_(settings) {
  if (own != nullptr) links_.push_back({strategy, std::move(own)});
}

Strategy& Attempts::strategy(std::string_view name) {
  for (Link& link : links_) {
    if (link.name == name) return *link.strategy;
  }
  if (const StrategyRow* row = find_row(strategy_table(), name); row != nullptr && row->make != nullptr) {
    links_.push_back({row->name, row->make(settings_)});
    return *links_.back().strategy;
  }
  throw std::logic_error("no strategy of this name: " + std::string(name));
}

// auto picks the interior point where a set is no interval; a named strategy must take it from its first link
// on.
SetKind Attempts::takes() { return strategy(strategy_ == "auto" ? "interior-point" : strategy_).takes(); }

bool Attempts::run_chain(SolveState& state, std::span<const double> warm_impulse) {
  SolveSummary& summary = *state.summary;
  const StrategyChoice choice = choose_strategies(strategy_, state);
  summary.auto_reason = choice.reason;
  chain_best_.clear();
  for (int k = 0; k < choice.count; ++k) {
    if (k > 0) {
      ++summary.fallbacks;
      if (strategy_ == "auto") summary.auto_reason += ", " + std::string(choice.names[k - 1]) + " stalled";
      // Not from where the last one got lost.
      state.begin(*state.step, *state.kernel, summary, warm_impulse);
    }
    summary.strategy = choice.names[k];
    if (strategy(choice.names[k]).run(state)) return true;
    state.update_velocity();
    chain_best_.offer(state);
  }
  chain_best_.restore(state);
  return false;
}

// Until the residual of the problem as it was asked, compliance zero, is at the target or falls no more.
// Between proximal steps the active set mostly stays: then a step is a correction by the factor at hand.
bool Attempts::run_proximal(SolveState& state) {
  const double target = state.target_m_per_s();
  const double tolerance = state.violation_tolerance();
  proximal_best_.clear();
  if (!state.factor_free()) return false;
  for (int k = 0, stalled = 0; k < kMostProximalSteps && stalled < kStalledProximalSteps; ++k) {
    proximal_.recentre(state.impulse);
    state.update_velocity();
    const double residual = state.residual();
    if (residual <= target) return true;
    stalled = residual < 0.9 * proximal_best_.residual ? 0 : stalled + 1;
    proximal_best_.offer(state);
    ++state.summary->refinements;
    state.refine_free(tolerance, SolveState::kSearchRefinements, SolveState::Refining::search);
    if (state.find_violations(tolerance) == 0 || state.settle(tolerance)) continue;
    state.begin(*state.step, *state.kernel, *state.summary, proximal_best_.impulse);
    if (!run_chain(state, proximal_best_.impulse)) break;
  }
  proximal_best_.restore(state);
  return proximal_best_.residual <= state.step->exact_limit_m_per_s();
}

// One run of the strategies, on the problem itself (delta 0) or by proximal steps.
bool Attempts::attempt(PreparedStep& step, Kernel& kernel, double delta, std::span<const double> warm_impulse,
                       SolveState& state, SolveSummary& summary) {
  {
    StageTimer timer(state.tasks.clock(), Stage::predict);
    if (delta > 0) {
      state.finish_analysis();  // which looks at the step
      proximal_.begin(step, warm_impulse, delta);
      step.prepare(proximal_.problem(), &state.tasks);
    }
    state.begin(step, kernel, summary, warm_impulse);
  }
  return run_chain(state, warm_impulse) && (delta == 0 || run_proximal(state));
}

// Proximal steps stand on an active set, which cones have not; the interior point's own delta serves those.
bool Attempts::run(PreparedStep& step, Kernel& kernel, std::span<const double> warm_impulse,
                   SolveState& state, SolveSummary& summary) {
  const StepProblem& problem = step.problem();
  const double stiffest = step.least_relative_compliance();
  const bool has_cones = !step.set().cones().empty();
  attempt_best_.clear();
  int attempts = 0;
  for (const double delta : kProximalDeltas) {
    if (delta > 0 && (stiffest >= delta || has_cones)) continue;
    if (attempts++ > 0) ++summary.fallbacks;
    if (attempt(step, kernel, delta, warm_impulse, state, summary)) return true;
    if (delta > 0) step.prepare(problem, &state.tasks);
    state.update_velocity();
    attempt_best_.offer(state);
  }
  attempt_best_.restore(state);
  return false;
}

}  // namespace cleave
