#include "harness/experiment/combination.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <new>

#include "harness/base/hash.h"
#include "harness/base/value_spans.h"
#include "harness/experiment/cell_measures.h"
#include "harness/experiment/friction_mismatch.h"
#include "solver/dispatch_cost.h"
#include "solver/problem_hash.h"

namespace cleave {
namespace {

// What the solver is handed; a solver that ignores parts receives none.
Parts solver_parts(const std::optional<Split>& split) {
  if (!split) return {};
  Parts parts(split->parts.part_of_body, split->parts.parent_of_part);
  parts.kernel = kernel_of_choice(split->parts.choice);
  return parts;
}

// The judge's word counts: a solver that says ok is believed only within the limit.
void judge_outcome(const StepProblem& problem, Outcome& outcome) {
  outcome.verdict = judge(problem, outcome.solution.impulse);
  outcome.finite = all_finite(outcome.solution.impulse) && all_finite(outcome.solution.velocity) &&
                   all_finite(outcome.verdict.velocity);
  if (!outcome.solved()) return;
  if (!outcome.finite) {
    outcome.status = SolveStatus::diverged;
  } else if (outcome.status == SolveStatus::ok && !outcome.verdict.exact) {
    outcome.status = SolveStatus::not_converged;
  }
}

// Nothing was found: what is left is where the solve would have started.
Outcome unsolved(const StepProblem& problem, SolveStatus status, const std::string& why) {
  Outcome outcome;
  outcome.status = outcome.summary.status = status;
  outcome.summary.message = why;
  outcome.solution = {problem.warm_impulse, problem.free_velocity};
  return outcome;
}

bool same_bytes(std::span<const double> a, std::span<const double> b) {
  return std::ranges::equal(std::as_bytes(a), std::as_bytes(b));
}

// Index of the median of a number per repeat; the lower middle one of an even number.
template <class Items, class Value>
std::size_t median_index(const Items& items, Value value) {
  std::vector<std::size_t> order(items.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return value(items[i]); });
  return order[(order.size() - 1) / 2];
}

template <class Items, class Value>
double median(const Items& items, Value value) {
  return value(items[median_index(items, value)]);
}

// Of repeats that all have parts.
template <class Repeats>
void set_split(const Repeats& repeats, StepRecord& row) {
  const Split& split = *repeats.front().split;
  row.set_partition_before(measure_partition(split.graph, split.before.part_of_body));
  row.set_partition(measure_partition(split.graph, split.parts.part_of_body));
  row.partition_origin = to_string(split.origin);
  if (!split.parts.choice.empty()) row.auto_choice = split.parts.choice;
  row.t_graph_ms = median(repeats, [](const auto& repeat) { return repeat.split->graph_ms; });
  row.t_partition_ms = median(repeats, [](const auto& repeat) { return repeat.split->partition_ms; });
  row.t_refine_ms = median(repeats, [](const auto& repeat) { return repeat.split->refine_ms; });
  row.t_pr_ms = median(
      repeats, [](const auto& repeat) { return repeat.split->partition_ms + repeat.split->refine_ms; });
}

void describe_split(const Split& split, Outcome& outcome) {
  outcome.parts = split.parts;
  outcome.origin = split.origin;
}

void set_outcome(const Outcome& outcome, StepRecord& row) {
  row.status = to_string(outcome.status);
  row.ode_messages += outcome.summary.engine_messages;
  row.set_summary(outcome.summary);
  if (outcome.solved()) row.set_model(outcome.model);
  row.peak_memory_mb = peak_memory_mb();
}

template <class Repeat>
double total_ms(const Repeat& repeat) {
  return repeat.outcome.summary.times.total_ms;
}

// Of repeats that were all solved, and of the one that the row is of.
template <class Repeats>
void set_times(const Repeats& repeats, const Outcome& outcome, StepRecord& row) {
  const auto [least, most] =
      std::ranges::minmax_element(repeats, {}, [](const auto& repeat) { return total_ms(repeat); });
  row.t_s_min_ms = total_ms(*least);
  row.t_s_max_ms = total_ms(*most);
  row.t_s_cpu_ms = outcome.cores.cpu_ms;
  row.t_s_waiting_ms = outcome.cores.waiting_ms;
  row.core_round_trip_ns = outcome.cores.round_trip_ns;
  row.solution_hash = hex(solution_hash(outcome.solution.impulse, outcome.parts.part_of_body));
}

// A solver that returned nothing left nothing to judge.
void set_verdict(const StepProblem& problem, const Outcome& outcome, StepRecord& row) {
  if (outcome.status != SolveStatus::ok && !outcome.summary.message.empty())
    row.status_reason = outcome.summary.message;
  if (!outcome.solved()) return;
  row.set_verdict(outcome.verdict);
  row.set_friction(friction_mismatch(problem, outcome.solution.impulse));
}

void set_measures(const StepProblem& problem, const BodyGraph* graph, const Outcome& outcome,
                  StepRecord& row) {
  const Cell cell{problem, graph, outcome.parts.part_of_body, outcome.solution, outcome.verdict};
  for (const CellMeasure& measure : cell_measures()) row.measures.push_back(measure.value(cell));
}

}  // namespace

Combination::Combination(const Algorithm& partitioner, const Algorithm& refiner, const Algorithm& solver,
                         const RunOptions& options, const StepContext& context, const std::atomic<bool>* stop)
    : name_{.solver = solver.text},
      solver_named_(solver),
      repeats_(options.repeats),
      solve_options_{.threads = options.threads,
                     .session = options.session,
                     .stop = stop,
                     .models_workers = true,
                     .dispatch = dispatch_cost(),
                     .memory_limit_bytes = options.memory_limit_bytes},
      context_(&context),
      solver_(make_solver(solver, solve_options_, context)),
      keeper_(options.repartition) {
  if (options.model == Model::automatic) planner_.emplace();
  if (solver_->uses_partition()) {
    setup_ = {partitioner, refiner, options.skip_small_islands, arity_of(solver), options.body_order};
    splitter_.emplace(setup_);
    name_.partitioner = partitioner.text;
    name_.refiner = refiner.text;
  }
}

std::optional<Split> Combination::split(const StepProblem& problem, int step) const {
  if (!splitter_) return std::nullopt;
  return keeper_.run(*splitter_, problem, step, {context_->position_m, context_->body_group});
}

// Once a step, after all repeats: each of them begins from the step before.
void Combination::remember(const std::optional<Split>& split) {
  if (split) {
    keeper_.remember(*splitter_, *split);
  } else {
    keeper_.forget();
  }
}

void Combination::follow(const StepProblem& problem, int step) {
  if (!keeper_.keeps()) return;
  check_stop(solve_options_.stop);
  std::optional<Split> parts;
  try {
    parts = split(problem, step);
  } catch (const CannotSplit&) {
    // As after a refused solve, the next step is split anew.
  }
  remember(parts);
}

Combination::Repeat Combination::repeat(const StepProblem& problem, int step) {
  check_stop(solve_options_.stop);
  Repeat repeat;
  try {
    repeat.split = split(problem, step);
    solve_parts(problem, solver_parts(repeat.split), repeat.outcome);
  } catch (const CannotSplit& error) {
    repeat.outcome = unsolved(problem, SolveStatus::refused, error.what());
  } catch (const std::bad_alloc&) {
    solver_.reset();  // its scratch is memory that the next one may need
    repeat.outcome = unsolved(problem, SolveStatus::out_of_memory, "no memory for the solve");
  }
  return repeat;
}

void Combination::solve_parts(const StepProblem& problem, const Parts& parts, Outcome& outcome) {
  if (solver_ == nullptr) solver_ = make_solver(solver_named_, solve_options_, *context_);
  outcome.solution.impulse = problem.warm_impulse;
  outcome.solution.velocity.assign(problem.free_velocity.size(), 0.0);
  const CoreMeter meter(solve_options_.threads);
  outcome.summary = planner_ ? planner_->solve(*solver_, problem, parts, outcome.solution, outcome.model)
                             : solver_->solve(problem, parts, outcome.solution);
  outcome.cores = meter.stop();
  outcome.status = outcome.summary.status;
}

void Combination::set_names(StepRecord& row) const {
  row.partitioner = name_.partitioner;
  row.refiner = name_.refiner;
  row.solver = name_.solver;
  for (const Algorithm* algorithm : {&setup_.partitioner, &setup_.refiner, &solver_named_})
    row.add_parameters(algorithm->settings);
}

Outcome Combination::solve(const StepProblem& problem, int step) {
  Repeat solved = repeat(problem, step);
  remember(solved.split);
  judge_outcome(problem, solved.outcome);
  return std::move(solved.outcome);
}

std::vector<Combination::Repeat> Combination::repeat_all(const StepProblem& problem, int step) {
  std::vector<Repeat> repeats;
  for (int i = 0; i < repeats_; ++i) {
    repeats.push_back(repeat(problem, step));
    if (!repeats.back().outcome.solved()) break;  // a failure has no time to take the median of
    // What one solve leaves in the solver's scratch must not reach the next, or repeats would time another
    // problem.
    assert(same_bytes(repeats.back().outcome.solution.impulse, repeats.front().outcome.solution.impulse));
  }
  return repeats;
}

Outcome Combination::measure(const StepProblem& problem, StepRecord& row) {
  std::vector<Repeat> repeats = repeat_all(problem, row.step);
  const bool solved = repeats.back().outcome.solved();
  Repeat& chosen = solved ? repeats[median_index(repeats, total_ms<Repeat>)] : repeats.back();
  judge_outcome(problem, chosen.outcome);
  remember(repeats.front().split);

  set_names(row);
  row.repeat_count = static_cast<int>(repeats.size());
  // Of repeats that split, one that found no memory is the last, and may have no parts.
  if (repeats.front().split)
    set_split(std::span(repeats).first(repeats.size() - (repeats.back().split ? 0 : 1)), row);
  if (chosen.split) describe_split(*chosen.split, chosen.outcome);
  set_outcome(chosen.outcome, row);
  set_verdict(problem, chosen.outcome, row);
  if (chosen.outcome.solved())
    set_measures(problem, chosen.split ? &chosen.split->graph : nullptr, chosen.outcome, row);
  if (solved) set_times(repeats, chosen.outcome, row);
  return std::move(chosen.outcome);
}

ConvergedBounds Combination::converge_bounds(StepProblem& problem, int step) {
  check_stop(solve_options_.stop);
  Solution solution{problem.warm_impulse, {}};
  // Where this fails, the solve that follows says why.
  try {
    if (solver_ == nullptr) solver_ = make_solver(solver_named_, solve_options_, *context_);
    const std::optional<Split> bodies = split(problem, step);
    return converge_friction_bounds(problem, *solver_, solver_parts(bodies), solution);
  } catch (const CannotSplit&) {
    return {};
  } catch (const std::bad_alloc&) {
    solver_.reset();
    return {};
  }
}

std::vector<Combination> make_combinations(const RunOptions& options, const StepContext& context,
                                           const std::atomic<bool>* stop) {
  std::vector<Combination> splitting, whole;
  for (const Algorithm& partitioner : options.partitioners)
    for (const Algorithm& refiner : options.refiners)
      for (const Algorithm& solver : options.solvers)
        if (uses_parts(solver)) splitting.emplace_back(partitioner, refiner, solver, options, context, stop);
  for (const Algorithm& solver : options.solvers)
    if (!uses_parts(solver)) whole.emplace_back(Algorithm{}, Algorithm{}, solver, options, context, stop);
  std::ranges::move(whole, std::back_inserter(splitting));
  return splitting;
}

std::vector<CombinationName> combination_names(const RunOptions& options) {
  const StepContext context;
  std::vector<CombinationName> names;
  for (const Combination& combination : make_combinations(options, context))
    names.push_back(combination.name());
  return names;
}

std::vector<Outcome> measure_all(std::span<Combination> combinations, const StepProblem& problem, int turn,
                                 std::span<StepRecord> rows) {
  std::vector<Outcome> outcomes(combinations.size());
  for (std::size_t k = 0; k < combinations.size(); ++k) {
    const std::size_t i = (k + static_cast<std::size_t>(turn)) % combinations.size();
    outcomes[i] = combinations[i].measure(problem, rows[i]);
  }
  return outcomes;
}

RunOptions without_history(RunOptions options) {
  options.session = false;
  options.repartition = {};
  options.body_order = {};
  options.model = Model::full;
  return options;
}

Combination make_advancing_combination(const RunOptions& options, const StepContext& context,
                                       const std::atomic<bool>* stop) {
  return {options.partitioners.front(),
          options.refiners.front(),
          options.advance,
          without_history(options),
          context,
          stop};
}

}  // namespace cleave
