#include "harness/experiment/option_overrides.h"

#include <algorithm>
#include <string_view>

#include "harness/base/names.h"
#include "harness/experiment/chosen_kernel.h"
#include "harness/experiment/option_errors.h"
#include "partition/registry.h"
#include "solver/registry.h"

namespace cleave {
namespace {

constexpr std::string_view kOfCost = "-cost";

// What aims at the modelled time in the place of this name: itself, or the one that is called after it.
// Empty: nothing does.
std::string twin_of_cost(const std::string& name, const std::vector<std::string>& names) {
  const std::string twin = name.ends_with(kOfCost) ? name : name + std::string(kOfCost);
  return std::ranges::count(names, twin) > 0 ? twin : std::string();
}

std::string refiner_of_cost(const std::string& name) {
  const std::vector<std::string> names = names_of(refiners());
  const std::string twin = name == "none" ? name : twin_of_cost(name, names);
  if (!twin.empty()) return twin;
  std::vector<std::string> allowed = {"none"};
  for (const std::string& other : names)
    if (other.ends_with(kOfCost)) allowed.push_back(other.substr(0, other.size() - kOfCost.size()));
  reject("objective",
         "cost is none of refiner '" + name + "'; allowed with it: --refiner " + joined(allowed, ","));
}

// What grows parts by a rule has no objective, and stays.
std::string partitioner_of_cost(const std::string& name) {
  const std::string twin = twin_of_cost(name, names_of(partitioners()));
  return twin.empty() ? name : twin;
}

// Every algorithm by its twin, with the parameters that it was given. What has no twin is not read again.
std::vector<Algorithm> of_cost(const std::string& option, const std::vector<Algorithm>& algorithms,
                               const std::function<std::string(const std::string& name)>& twin_of,
                               const CommonValues& common) {
  std::vector<Algorithm> changed;
  for (const Algorithm& a : algorithms) {
    const std::string twin = twin_of(a.name) + a.text.substr(a.name.size());
    append_once(option, twin, twin == a.text ? a : read_named(option, twin, common), changed);
  }
  return changed;
}

// Why the run cannot have its bodies split by it; empty: it can.
std::string why_unable(const Algorithm& partitioner, const RunOptions& options) {
  const PartitionerEntry& row = partitioner_row(partitioner.name);
  if (options.skip_small_islands && !partitioner.settings.has("max-bodies"))
    return "which has no max-bodies, as --skip-small-islands needs";
  for (const Algorithm& solver : options.solvers)
    if (solver_halves(solver.name).kernel == kChosenKernel && !row.traits.makes_choices)
      return "which chooses its parts for no kernel, as " + solver.text + " needs";
  const bool has_groups = options.scene.name.empty() || names_groups(options.scene);
  if (row.traits.needs_groups && !has_groups)
    return "which splits by groups of bodies, and scene " + options.scene.name + " names none";
  const std::string twin = partitioner_of_cost(partitioner.name);
  if (options.objective == Objective::cost && twin != partitioner.name)
    return "which " + twin + " replaces under --objective cost";
  return {};
}

// The option that joins a strategy and a kernel that are no pair.
void check_goes_together(const SolverHalves& halves, const Algorithm& solver, const CommonValues& given) {
  const std::vector<std::string> names = names_for("solver");
  if (std::ranges::count(names, halves.strategy + ":" + halves.kernel) > 0) return;
  const bool is_kernel = given.contains("kernel");
  std::vector<std::string> allowed;
  for (const std::string& name : names) {
    const SolverHalves other = solver_halves(name);
    if (name == other.strategy + ":" + other.kernel &&
        (is_kernel ? other.strategy == halves.strategy : other.kernel == halves.kernel))
      allowed.push_back(is_kernel ? other.kernel : other.strategy);
  }
  reject(is_kernel ? "kernel" : "strategy",
         "'" + (is_kernel ? halves.kernel : halves.strategy) + "' does not go with " +
             (is_kernel ? "strategy " + halves.strategy : "kernel " + halves.kernel) + " (--solver " +
             solver.text + "); allowed: " + joined(allowed));
}

}  // namespace

void override_solvers(const std::map<std::string, std::string>& given, RunOptions& options) {
  if (!given.contains("strategy") && !given.contains("kernel")) return;
  if (given.contains("strategy")) check_name("--strategy", options.strategy, names_for("strategy"));
  if (given.contains("kernel")) check_name("--kernel", options.kernel, names_for("kernel"));
  std::vector<std::string> changed;
  for (const Algorithm& solver : options.solvers) {
    SolverHalves halves = solver_halves(solver.name);
    if (halves.strategy.empty())
      reject("solver",
             "'" + solver.name + "' has neither strategy nor kernel; leave out --strategy and --kernel");
    if (!options.strategy.empty()) halves.strategy = options.strategy;
    if (!options.kernel.empty()) halves.kernel = options.kernel;
    check_goes_together(halves, solver, given);
    changed.push_back(halves.strategy + ":" + halves.kernel + solver.text.substr(solver.name.size()));
  }
  options.solvers = read_list("solver", joined(changed, ","), options.common);
}

void override_objective(RunOptions& options) {
  if (options.objective == Objective::rows) return;
  options.refiners = of_cost("refiner", options.refiners, refiner_of_cost, options.common);
  options.partitioners = of_cost("partitioner", options.partitioners, partitioner_of_cost, options.common);
  const auto aims_at_cost = [](const Algorithm& algorithm) { return algorithm.name.ends_with(kOfCost); };
  if (std::ranges::none_of(options.refiners, aims_at_cost) &&
      std::ranges::none_of(options.partitioners, aims_at_cost))
    options.notes.push_back(
        "--objective cost changes nothing: no partitioner or refiner of this run has an objective");
}

void leave_out_of_all(const std::function<std::string(const Algorithm& partitioner)>& why,
                      RunOptions& options) {
  std::erase_if(options.partitioners, [&](const Algorithm& partitioner) {
    if (std::ranges::count(options.of_all, partitioner.text) == 0) return false;
    const std::string reason = why(partitioner);
    if (!reason.empty())
      options.notes.push_back("--partitioner all leaves out " + partitioner.text + ", " + reason);
    return !reason.empty();
  });
}

void leave_out_unable(const std::map<std::string, std::string>& given, RunOptions& options) {
  const auto found = given.find("partitioner");
  if (found == given.end()) return;
  const std::vector<std::string> items = split_list(found->second);
  if (std::ranges::count(items, "all") == 0) return;
  for (const Algorithm& partitioner : options.partitioners)  // all stands for bare names
    if (partitioner.text == partitioner.name && std::ranges::count(items, partitioner.text) == 0)
      options.of_all.push_back(partitioner.text);
  leave_out_of_all([&](const Algorithm& partitioner) { return why_unable(partitioner, options); }, options);
}

}  // namespace cleave
