#include "harness/experiment/simulation.h"

#include <cmath>

#include <algorithm>
#include <string>
#include <utility>

#include "harness/base/hash.h"
#include "harness/base/stopwatch.h"
#include "harness/base/value_spans.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/step_columns.h"
#include "harness/world/contact_memory.h"
#include "harness/world/extract.h"
#include "harness/world/joint_rows.h"
#include "solver/parallel_tasks.h"

namespace cleave {
namespace {

// Positions may overflow where velocities did not; there is nothing to collide then.
bool is_finite(const OdeWorld& world) {
  return std::isfinite(world.potential_energy_j()) && std::isfinite(world.kinetic_energy_j());
}

// None where one has overflown, in a coordinate that no energy tells of.
std::vector<double> known_positions(const OdeWorld& world) {
  std::vector<double> positions_m = world.positions_m();
  return all_finite(positions_m) ? positions_m : std::vector<double>();
}

std::string why_stopped(int step, const Outcome& advance) {
  const std::string stopped = "the world stopped at step " + std::to_string(step) + ": ";
  if (advance.can_advance()) return stopped + "positions are no numbers";
  const std::string& message = advance.summary.message;
  return stopped + to_string(advance.status) + (message.empty() ? "" : ", " + message);
}

}  // namespace

// The step loop. A run is this and nothing else; every line below is one room of the program.
void Simulation::run_world(std::span<Combination> combinations, Combination& advancing, const RowSink& write,
                           const Progress& progress) {
  OdeWorld world(scene_row(options_.scene), options_.scene.settings, options_.seed,
                 options_.gravity_m_per_s2);
  ContactMemory memory(options_.match_tolerance);

  for (int step = 0; step < options_.steps && !stop_; ++step) {
    StepRecord common = blank_row(step);
    const StepProblem problem = pose_problem(world, memory, advancing, common);

    // Every combination splits the bodies and solves the same problem.
    Measured measured;
    if (is_measured(step)) {
      set_problem_columns(problem, common);
      common.max_penetration_m = deepest_m(contacts_);
      measured = measure(combinations, problem, common);
    } else if (options_.session) {
      for (Combination& combination : combinations) combination.solve(problem, step);
    } else {
      for (Combination& combination : combinations) combination.follow(problem, step);
    }

    // One solution moves the bodies, and its impulses are where the next step starts from.
    const Outcome advance = advancing.solve(problem, step);
    if (observe_) observe_({context_, problem, step, measured.rows, measured.outcomes});
    if (advance.can_advance()) {
      world.advance(advance.verdict.velocity, options_.extract.h_s);
      memory.remember(contacts_, problem, advance.solution.impulse);
    }

    finish_rows(measured, world, advance);
    record(measured.rows, write);
    count_step(measured, advance);
    progress(summary_.steps, total_steps());
    if (!advance.can_advance() || !is_finite(world))
      return record_skipped(combinations, step + 1, why_stopped(step, advance), write);
  }
}

// What the world asks of this step; sets the context of the step, and the times and counts of getting there.
StepProblem Simulation::pose_problem(OdeWorld& world, ContactMemory& memory, Combination& advancing,
                                     StepRecord& common) {
  world.before_step(common.step);
  Stopwatch watch;

  // Where shapes touch.
  contacts_ = world.collide(options_.contact_cap, &common.contact_cap_hits);
  common.t_collide_ms = watch.lap_ms();

  // One constraint row per joint direction, contact normal and friction direction.
  StepProblem problem = extract(world, contacts_, options_.extract, memory);
  common.t_extract_ms = watch.lap_ms();

  // Converged bounds are found by solving, with ODE's own solvers too.
  context_ = {&world,
              contacts_,
              options_.extract.erp,
              options_.extract.cfm,
              known_positions(world),
              world.body_groups()};
  watch.lap_ms();
  set_friction(problem, advancing, common.step);
  common.t_predict_ms = watch.lap_ms();
  common.ode_messages = world.take_message_count();
  return problem;
}

void Simulation::count_step(const Measured& measured, const Outcome& advance) {
  ++summary_.steps;
  if (advance.status != SolveStatus::ok) ++summary_.inexact_advances;
  if (measured.rows.empty()) return;
  ++summary_.measured_steps;
  if (measured.rows.front().contacts > 0) ++summary_.measured_with_contacts;
}

Simulation::Simulation(const RunOptions& options, const std::atomic<bool>& stop, Observer observe)
    : options_(options),
      stop_(stop),
      observe_(std::move(observe)),
      run_row_(run_columns(options)),
      combinations_(make_combinations(options, context_, &stop)) {}

RunSummary Simulation::run(const RowSink& write, const Progress& progress) {
  Stopwatch watch;
  try {
    run_worlds(write, progress);
  } catch (const Stopped&) {
    // The rows of the step at hand are not all there, so none is written.
  }
  summary_.wall_s = watch.lap_ms() / 1000;
  summary_.interrupted = stop_;
  return summary_;
}

void Simulation::run_worlds(const RowSink& write, const Progress& progress) {
  start_threads(options_.threads);
  if (options_.mode == RunMode::lockstep) {
    Combination advancing = make_advancing_combination(options_, context_, &stop_);
    run_world(combinations_, advancing, write, progress);
  } else {
    // Equal solvers that advance: one does not see what the other keeps in its scratch.
    std::vector<Combination> advancing = make_combinations(without_history(options_), context_, &stop_);
    for (std::size_t i = 0; i < combinations_.size(); ++i)
      run_world({&combinations_[i], 1}, advancing[i], write, progress);
  }
}

StepRecord Simulation::blank_row(int step) const {
  StepRecord row = run_row_;
  row.step = step;
  row.time_s = step * options_.extract.h_s;
  return row;
}

bool Simulation::is_measured(int step) const {
  if (options_.at.empty()) return step % options_.measure_every == options_.measure_every - 1;
  return std::ranges::binary_search(options_.at, step);
}

long long Simulation::total_steps() const {
  const std::size_t worlds = options_.mode == RunMode::lockstep ? 1 : combinations_.size();
  return static_cast<long long>(worlds) * options_.steps;
}

// What friction rows may carry is fixed before anyone solves, so that all combinations have the same problem.
void Simulation::set_friction(StepProblem& problem, Combination& advancing, int step) {
  const FrictionModelEntry& model = friction_model(options_.extract.friction);
  if (model.set != nullptr) model.set(options_.extract, problem);
  if (model.model != FrictionModel::box_converged) return;
  if (!advancing.converge_bounds(problem, step).converged) ++summary_.unconverged_bounds;
}

Simulation::Measured Simulation::measure(std::span<Combination> combinations, const StepProblem& problem,
                                         const StepRecord& common) {
  Measured measured{std::vector<StepRecord>(combinations.size(), common), {}};
  measured.outcomes = measure_all(combinations, problem, summary_.measured_steps, measured.rows);
  return measured;
}

void Simulation::finish_rows(Measured& measured, const OdeWorld& world, const Outcome& advance) {
  if (measured.rows.empty()) return;
  const double drift_m = joint_drift_m(world), potential_energy_j = world.potential_energy_j();
  const std::string state_hash = hex(world.state_hash());
  for (std::size_t i = 0; i < measured.rows.size(); ++i) {
    StepRecord& row = measured.rows[i];
    row.potential_energy_j = potential_energy_j;
    row.joint_drift_m = drift_m;
    row.last_body_z_m = world.last_body_z_m();
    row.state_hash = state_hash;
    if (!measured.outcomes[i].solved()) continue;
    row.velocity_spread_m_per_s =
        largest_difference(measured.outcomes[i].solution.velocity, advance.verdict.velocity);
  }
}

void Simulation::record(std::span<const StepRecord> rows, const RowSink& write) {
  for (const StepRecord& row : rows) summary_.add(row);
  write(rows);
}

// A world that cannot go on leaves rows, not gaps.
void Simulation::record_skipped(std::span<const Combination> combinations, int first_step,
                                const std::string& reason, const RowSink& write) {
  ++summary_.stopped_worlds;
  for (int step = first_step; step < options_.steps; ++step) {
    if (!is_measured(step)) continue;
    std::vector<StepRecord> rows(combinations.size(), blank_row(step));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      combinations[i].set_names(rows[i]);
      rows[i].status_reason = reason;
    }
    record(rows, write);
  }
}

}  // namespace cleave
