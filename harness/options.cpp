#include "harness/options.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>

#include "harness/hash.h"
#include "harness/nearest_name.h"
#include "harness/ode_baselines.h"
#include "harness/options_text.h"
#include "partition/registry.h"
#include "solver/registry.h"

namespace cleave {
namespace {

using Given = std::map<std::string, std::string>;
constexpr const char* kOutIsRequired = "is required: the directory for steps.csv and manifest.json";

[[noreturn]] void reject(const std::string& option, const std::string& text) {
  throw std::invalid_argument("--" + option + ": " + text);
}

void require(const Given& given, const std::string& option, const std::string& text) {
  if (!given.contains(option)) reject(option, text);
}

void exclude(const Given& given, const std::string& option, const std::string& text) {
  if (given.contains(option)) reject(option, text);
}

// Given options in the table's order, so that of two mistakes the same one is always reported first; the rest
// is the scene's.
Given read_table(const Given& given, RunOptions& options) {
  Given rest = given;
  for (const OptionSpec& spec : run_option_specs()) {
    const auto found = given.find(spec.name);
    if (found == given.end()) continue;
    spec.set(options, found->second);
    rest.erase(spec.name);
  }
  return rest;
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

void check_friction(const Given& given, const RunOptions& options) {
  if (options.extract.friction == FrictionModel::constant)
    require(given, "friction-force-n", "is required by --friction constant");
  else
    exclude(given, "friction-force-n", "has a meaning only with --friction constant");
  if (options.extract.friction == FrictionModel::constant &&
      options.ode_baseline.friction == OdeFriction::pyramid)
    reject("ode-friction",
           "pyramid follows normal forces, which --friction constant does not; allowed: limits");
}

// The two halves of a solver name; short names have them in the table, a baseline has none.
std::pair<std::string, std::string> halves(const std::string& solver) {
  const std::size_t colon = solver.find(':');
  if (colon != std::string::npos) return {solver.substr(0, colon), solver.substr(colon + 1)};
  for (const SolverRow& row : solver_table())
    if (row.entry.name == solver && row.strategy != nullptr) return {row.strategy, row.kernel};
  reject("solver", "'" + solver + "' has neither strategy nor kernel; leave out --strategy and --kernel");
}

// Replaces one or both halves of every solver name.
void override_solvers(const Given& given, RunOptions& options) {
  if (!given.contains("strategy") && !given.contains("kernel")) return;
  if (given.contains("strategy")) check_name("strategy", options.strategy, names_of(strategy_table()));
  if (given.contains("kernel")) check_name("kernel", options.kernel, names_of(kernel_table()));
  std::vector<std::string> changed;
  for (const std::string& solver : options.solvers) {
    auto [strategy, kernel] = halves(solver);
    if (!options.strategy.empty()) strategy = options.strategy;
    if (!options.kernel.empty()) kernel = options.kernel;
    changed.push_back(strategy + ":" + kernel);
  }
  options.solvers = parse_names("solver", joined(changed, ","), all_solver_names(), false);
}

}  // namespace

const SceneEntry& find_scene(const std::string& name) {
  check_name("scene", name, names_of(scenes()));
  return *std::ranges::find_if(scenes(), [&](const SceneEntry& scene) { return scene.name == name; });
}

RunOptions default_run_options() {
  RunOptions options;
  options.partitioners = names_of(partitioners());
  options.refiners = names_of(refiners());
  options.solvers = {"schur"};
  options.advance = "exact";
  return options;
}

RunOptions parse_run_options(const std::map<std::string, std::string>& given) {
  require(given, "scene", "is required; choices: " + joined(names_of(scenes())));
  require(given, "out", kOutIsRequired);
  RunOptions options = default_run_options();
  const Given scene_given = read_table(given, options);
  options.scene_options = make_scene_settings(find_scene(options.scene), scene_given).values();
  read_stiffness(given, options);
  check_friction(given, options);
  override_solvers(given, options);
  if (options.mode == RunMode::separate) {
    exclude(given, "advance",
            "has a meaning only in lockstep: in --mode separate every combination advances its world");
    exclude(given, "record-motion", "records one world; --mode separate has one per combination");
  }
  if (options.steps > 0 && options.measure_every > options.steps)
    reject("measure-every", std::to_string(options.measure_every) + " measures none of --steps " +
                                std::to_string(options.steps) + ", allowed: 1 to " +
                                std::to_string(options.steps));
  return options;
}

RunOptions parse_solve_options(const std::map<std::string, std::string>& given) {
  require(given, "out", kOutIsRequired);
  RunOptions options = default_run_options();
  [[maybe_unused]] const Given rest = read_table(given, options);
  assert(rest.empty());
  override_solvers(given, options);
  for (const SolverEntry& baseline : ode_baselines())
    if (std::ranges::count(options.solvers, baseline.name) > 0)
      reject("solver", std::string(baseline.name) +
                           " is ODE's own and needs the world of a run; a problem file holds none");
  return options;
}

std::vector<OptionValue> option_values(const RunOptions& options) {
  std::vector<OptionValue> values;
  for (const OptionSpec& spec : run_option_specs())
    values.push_back({spec.name, spec.kind, spec.get(options)});
  for (const auto& [name, text] : options.scene_options)
    values.push_back({name, OptionSpec::Kind::text, text});
  if (!options.at.empty()) values.push_back({"at", OptionSpec::Kind::text, joined_numbers(options.at)});
  return values;
}

std::string run_id(std::span<const OptionValue> values) {
  Fnv1a64 hash;
  for (const OptionValue& value : values) {
    if (value.name == "threads" || value.name == "out" || value.name == "force" || value.name == "files" ||
        value.name == "record-motion")
      continue;
    hash.add(value.name + "=" + value.text + "\n");
  }
  return hex(hash.value());
}

}  // namespace cleave
