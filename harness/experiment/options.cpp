#include "harness/experiment/options.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "harness/base/names.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/memory_limit.h"
#include "harness/experiment/option_errors.h"
#include "harness/experiment/option_overrides.h"
#include "harness/world/ode_baselines.h"
#include "partition/registry.h"
#include "solver/registry.h"

namespace cleave {
namespace {

using Given = std::map<std::string, std::string>;
constexpr const char* kOutIsRequired = "is required: the directory for steps.csv and manifest.json";

RunOptions options_with(const CommonValues& common) {
  RunOptions options;
  options.common = common;
  options.partitioners = read_list("partitioner", "paper", common);
  options.refiners = read_list("refiner", "paper", common);
  options.solvers = read_list("solver", "schur", common);
  options.advance = read_named("advance", "exact", common);
  options.friction = read_named("friction", "box", common);
  return options;
}

// The values that are no options of the table: those of algorithms, checked, and the rest, which is the
// scene's.
CommonValues read_common(const Given& given) {
  Given rest = given;
  for (const OptionSpec& spec : run_option_specs()) rest.erase(spec.name);
  for (const CommonParameter& common : common_parameters()) {
    const auto found = rest.find(common.parameter.name);
    if (found != rest.end())
      found->second = checked_value(common.parameter, "--" + found->first, found->second);
  }
  return rest;
}

// Given options in the table's order, so that of two mistakes the same one is always reported first.
void read_table(const Given& given, RunOptions& options) {
  for (const OptionSpec& spec : run_option_specs()) {
    const auto found = given.find(spec.name);
    if (found != given.end()) spec.set(options, found->second);
  }
}

// A scene's options, as far as they are not parameters of algorithms.
Given scene_given(const CommonValues& common) {
  Given rest;
  for (const auto& [name, value] : common)
    if (find_common_parameter(name) == nullptr) rest.emplace(name, value);
  return rest;
}

void append(const std::vector<Algorithm>& more, std::vector<const Algorithm*>& to) {
  for (const Algorithm& algorithm : more) to.push_back(&algorithm);
}

// A value that nothing in the run reads would do nothing. idle: what is named and has no part in the run.
void check_is_read(const std::string& name, const std::vector<const Algorithm*>& all,
                   const std::vector<const Algorithm*>& idle = {}) {
  std::string own;
  for (const Algorithm* algorithm : all) {
    if (!algorithm->settings.has(name)) continue;
    if (!names_parameter(algorithm->text, name)) return;
    own += (own.empty() ? "" : ", ") + algorithm->text;
  }
  const auto has = [&](const Algorithm* algorithm) { return algorithm->settings.has(name); };
  if (const auto found = std::ranges::find_if(idle, has); own.empty() && found != idle.end())
    reject(name, "is a parameter of " + (*found)->name + ", and no solver of this run splits bodies");
  if (own.empty()) reject(name, "is a parameter of " + owners_of(name) + "; nothing in this run has it");
  reject(name, "would do nothing, as all that have it say their own: " + own);
}

std::vector<const Algorithm*> solvers_of(const RunOptions& options, bool with_world) {
  std::vector<const Algorithm*> all;
  append(options.solvers, all);
  if (with_world && options.mode == RunMode::lockstep) all.push_back(&options.advance);
  return all;
}

bool any_splits(const std::vector<const Algorithm*>& solvers) {
  return std::ranges::any_of(solvers, [](const Algorithm* solver) { return uses_parts(*solver); });
}

// Campaigns may name partitioners for all their cells, and some cells have no use for them: told, not
// refused.
void tell_of_idle_partitions(const Given& given, const std::set<std::string>& stored, bool with_world,
                             RunOptions& options) {
  if (any_splits(solvers_of(options, with_world))) return;
  std::vector<std::string> idle;
  for (const char* name : {"partitioner", "refiner", "repartition", "body-order", "objective"})
    if (given.contains(name) && !stored.contains(name)) idle.push_back(std::string("--") + name);
  if (idle.empty()) return;
  options.notes.push_back(joined(idle) + (idle.size() == 1 ? " changes" : " change") +
                          " nothing: no solver of this run splits bodies");
}

void check_owned(const RunOptions& options, const std::set<std::string>& stored, bool with_world) {
  std::vector<const Algorithm*> all = solvers_of(options, with_world), idle;
  const bool splits = any_splits(all);
  append(options.partitioners, splits ? all : idle);
  append(options.refiners, splits ? all : idle);
  if (with_world) all.push_back(&options.friction);
  for (const auto& [name, value] : options.common) {
    if (stored.contains(name)) continue;
    if (find_common_parameter(name) != nullptr) {
      check_is_read(name, all, idle);
    } else if (with_world) {
      check_is_read(name, {&options.scene});
    }
  }
}

// A spring k with damper d per constraint, as ODE's manual maps it to erp and cfm.
void read_stiffness(const Given& given, RunOptions& options) {
  if (!given.contains("stiffness") && !given.contains("damping")) return;
  require(given, "stiffness", "is required beside --damping");
  require(given, "damping", "is required beside --stiffness");
  exclude(given, "erp", "is set by --stiffness and --damping and cannot be given beside them");
  exclude(given, "cfm", "is set by --stiffness and --damping and cannot be given beside them");
  const double h_k = options.extract.h_s * options.stiffness_n_per_m;
  options.extract.erp = h_k / (h_k + options.damping_n_s_per_m);
  options.extract.cfm = 1 / (h_k + options.damping_n_s_per_m);
  if (!std::isfinite(options.extract.erp) || !std::isfinite(options.extract.cfm))
    reject("stiffness", number_text(options.stiffness_n_per_m) + " overflows with this --dt and --damping");
}

// The friction model and its parameters as extraction takes them.
void read_friction(RunOptions& options) {
  const Settings& settings = options.friction.settings;
  options.extract.friction = friction_model(options.friction.name).model;
  if (settings.has("mu")) options.extract.mu = settings.number("mu");
  if (settings.has("bound-sweeps")) options.extract.bound_sweeps = settings.integer("bound-sweeps");
  if (settings.has("friction-force-n"))
    options.extract.friction_force_n = settings.number("friction-force-n");
  if (options.extract.friction != FrictionModel::constant) return;
  std::vector<const Algorithm*> solvers{&options.advance};
  append(options.solvers, solvers);
  for (const Algorithm* solver : solvers)
    if (solver->settings.has("ode-friction") && ode_friction(solver->settings) == OdeFriction::pyramid)
      reject("ode-friction",
             "pyramid follows normal forces, which --friction constant does not; allowed: limits");
}

// A second solve of the same step would start from the answer of the first.
void read_session(const Given& given, RunOptions& options) {
  if (!options.session) return;
  if (given.contains("repeats") && options.repeats != 1)
    reject("repeats",
           std::to_string(options.repeats) + " is not 1, which --session allows: it solves every step once");
  options.repeats = 1;
}

// The first of ODE's own solvers that the run has; empty: none.
std::string ode_solver_of(const RunOptions& options) {
  for (const AlgorithmEntry& ode : ode_baselines())
    if (std::ranges::count(options.solvers, ode.name, &Algorithm::name) > 0) return ode.name;
  return {};
}

// They read the world and would solve every row of it.
void check_reads_problem(const RunOptions& options) {
  if (const std::string ode = ode_solver_of(options); !ode.empty())
    reject("model", "auto leaves rows out of the step problem, which --solver " + ode +
                        " does not read; allowed: full");
}

}  // namespace

RunOptions default_run_options() { return options_with({}); }

RunOptions parse_run_options(const std::map<std::string, std::string>& given,
                             const std::set<std::string>& stored) {
  require(given, "scene", "is required; choices: " + joined(names_of(scenes())));
  require(given, "out", kOutIsRequired);
  RunOptions options = options_with(read_common(given));
  read_table(given, options);
  check_scene_options(scene_row(options.scene), scene_given(options.common));
  read_stiffness(given, options);
  override_solvers(given, options);
  leave_out_unable(given, options);
  override_objective(options);
  read_session(given, options);
  read_friction(options);
  if (options.model == Model::automatic) check_reads_problem(options);
  check_owned(options, stored, true);
  tell_of_idle_partitions(given, stored, true, options);
  if (options.mode == RunMode::separate) {
    exclude(given, "advance",
            "has a meaning only in lockstep: in --mode separate every combination advances its world");
    exclude(given, "record-motion", "records one world; --mode separate has one per combination");
    exclude(given, "explain-model", "watches one world; --mode separate has one per combination");
  }
  if (options.steps > 0 && options.measure_every > options.steps)
    reject("measure-every", std::to_string(options.measure_every) + " measures none of --steps " +
                                std::to_string(options.steps) + ", allowed: 1 to " +
                                std::to_string(options.steps));
  if (options.skip > 0 && options.skip >= options.steps && !stored.contains("skip"))
    reject("skip",
           std::to_string(options.skip) + " leaves out all of --steps " + std::to_string(options.steps));
  options.memory_limit_bytes = memory_limit_bytes(options.memory_limit_gb);
  return options;
}

RunOptions parse_solve_options(const std::map<std::string, std::string>& given,
                               const std::set<std::string>& stored) {
  require(given, "out", kOutIsRequired);
  RunOptions options = options_with(read_common(given));
  read_table(given, options);
  override_solvers(given, options);
  leave_out_unable(given, options);
  override_objective(options);
  read_session(given, options);
  check_owned(options, stored, false);
  tell_of_idle_partitions(given, stored, false, options);
  if (const std::string ode = ode_solver_of(options); !ode.empty())
    reject("solver", ode + " is ODE's own and needs the world of a run; a problem file holds none");
  options.memory_limit_bytes = memory_limit_bytes(options.memory_limit_gb);
  return options;
}

}  // namespace cleave
