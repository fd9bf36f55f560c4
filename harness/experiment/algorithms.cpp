#include "harness/experiment/algorithms.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "harness/base/names.h"
#include "harness/base/refusals.h"
#include "harness/experiment/chosen_kernel.h"
#include "harness/experiment/friction.h"
#include "harness/world/ode_baselines.h"
#include "partition/registry.h"
#include "solver/registry.h"

namespace cleave {
namespace {

template <class Row>
std::vector<AlgorithmEntry> entries_of(std::span<const Row> table) {
  return {table.begin(), table.end()};
}

template <class Row>
AlgorithmKind kind_of(const char* option, const char* plural, About about, bool in_replay,
                      std::span<const Row> table) {
  return {option, plural, about, in_replay, entries_of(table), names_of(table)};
}

std::vector<AlgorithmKind> make_kinds() {
  std::vector<AlgorithmKind> kinds = {
      kind_of("scene", "scenes", About::problem, false, scenes()),
      kind_of("partitioner", "partitioners", About::partition, true, partitioners()),
      kind_of("refiner", "refiners", About::partition, true, refiners()),
      kind_of("solver", "solvers", About::solver, true, solver_table()),
      kind_of("solver", "ODE's solvers", About::solver, false, ode_baselines()),
      kind_of("strategy", "strategies", About::solver, true, strategy_table()),
      kind_of("kernel", "kernels", About::solver, true, kernel_table()),
      kind_of("friction", "frictions", About::problem, false, friction_models()),
  };
  const auto first_of = [&kinds](std::string_view option) -> AlgorithmKind& {
    return *std::ranges::find(kinds, option, &AlgorithmKind::option);
  };
  // --solver takes pairs too, and --advance whatever --solver takes.
  std::vector<std::string>& solvers = first_of("solver").names;
  solvers = all_solver_names();
  std::ranges::copy(chosen_kernel_solvers(), std::back_inserter(solvers));
  first_of("kernel").entries.push_back(chosen_kernel());
  first_of("kernel").names.push_back(chosen_kernel().name);
  return kinds;
}

bool is_solver(const std::string& option) { return option == "solver" || option == "advance"; }

// What a list may name at once. Keyword rows of one table.
struct Keywords {
  const char* option;
  std::vector<std::string> paper;
};

template <class Row>
std::vector<std::string> names_of_paper(std::span<const Row> table) {
  std::vector<std::string> names;
  for (const Row& row : table)
    if (row.traits.of_paper) names.push_back(row.name);
  return names;
}

std::span<const Keywords> keywords() {
  static const Keywords table[] = {{"partitioner", names_of_paper(partitioners())},
                                   {"refiner", names_of_paper(refiners())}};
  return table;
}

const AlgorithmEntry* find_entry(const std::string& option, const std::string& name) {
  for (const AlgorithmKind& kind : algorithm_kinds())
    if (kind.option == option)
      for (const AlgorithmEntry& entry : kind.entries)
        if (entry.name == name) return &entry;
  return nullptr;
}

// The items of a list with keywords replaced by what they stand for.
std::vector<std::string> expanded(const std::string& option, const std::string& text,
                                  const CommonValues& common, std::vector<std::string>* left_out) {
  const auto row =
      std::ranges::find(keywords(), option, [](const Keywords& k) { return std::string(k.option); });
  std::vector<std::string> items;
  for (const std::string& item : split_list(text)) {
    if (const std::string name = algorithm_name(item);
        row != keywords().end() && item != name && (name == "paper" || name == "all"))
      throw std::invalid_argument("--" + option + ": '" + item + "': " + name +
                                  " stands for several names and takes no parameters; give them as options");
    if (row != keywords().end() && item == "paper") {
      std::ranges::copy(row->paper, std::back_inserter(items));
    } else if (row != keywords().end() && item == "all") {
      for (const std::string& name : names_for(option)) {
        const std::string reason = reason_to_leave_out(*find_entry(option, name), common);
        if (reason.empty()) {
          items.push_back(name);
        } else if (left_out != nullptr) {
          left_out->push_back("--" + option + " all leaves out " + name + ", which " + reason);
        }
      }
    } else {
      items.push_back(item);
    }
  }
  return items;
}

std::vector<CommonParameter> collect_common() {
  std::vector<CommonParameter> all;
  for (const AlgorithmKind& kind : algorithm_kinds()) {
    if (kind.option == std::string("scene")) continue;
    for (const AlgorithmEntry& entry : kind.entries)
      for (const Parameter& parameter : entry.parameters) {
        if (parameter.kind == Parameter::Kind::path) continue;
        const auto same = [&](const CommonParameter& other) {
          return other.parameter.name == parameter.name;
        };
        const auto found = std::ranges::find_if(all, same);
        if (found == all.end()) {
          all.push_back({parameter, owners_of(parameter.name), kind.about, kind.in_replay});
        } else {
          found->in_replay |= kind.in_replay;
        }
      }
  }
  return all;
}

}  // namespace

std::span<const AlgorithmKind> algorithm_kinds() {
  static const std::vector<AlgorithmKind> kinds = make_kinds();
  return kinds;
}

std::vector<std::string> names_for(const std::string& option) {
  std::vector<std::string> names;
  for (const AlgorithmKind& kind : algorithm_kinds())
    if (kind.option == option || (is_solver(option) && std::string(kind.option) == "solver"))
      std::ranges::copy(kind.names, std::back_inserter(names));
  return names;
}

std::string owners_of(const std::string& parameter) {
  std::vector<std::string> owners;
  for (const AlgorithmKind& kind : algorithm_kinds()) {
    std::vector<std::string> names;
    for (const AlgorithmEntry& entry : kind.entries)
      if (has_parameter(entry, parameter)) names.push_back(entry.name);
    if (!names.empty())
      owners.push_back(std::string(names.size() == 1 ? kind.option : kind.plural) + " " + joined(names));
  }
  return joined(owners, "; ");
}

std::span<const CommonParameter> common_parameters() {
  static const std::vector<CommonParameter> all = collect_common();
  return all;
}

const CommonParameter* find_common_parameter(const std::string& name) {
  for (const CommonParameter& common : common_parameters())
    if (common.parameter.name == name) return &common;
  return nullptr;
}

std::vector<Parameter> parameters_of(const std::string& option, const std::string& name) {
  for (const AlgorithmKind& kind : algorithm_kinds()) {
    const bool asked = kind.option == option || (is_solver(option) && kind.option == std::string("solver"));
    if (!asked || std::ranges::count(kind.names, name) == 0) continue;
    for (const AlgorithmEntry& entry : kind.entries)
      if (entry.name == name && !entry.parameters.empty()) return entry.parameters;
    if (!is_solver(option)) return {};
    const std::vector<Parameter> chosen = chosen_kernel_parameters(name);
    return chosen.empty() ? solver_parameters(name) : chosen;
  }
  throw std::logic_error("--" + option + " has no " + name);
}

ContentReader content_of(const std::string& option, const std::string& name) {
  const AlgorithmEntry* entry = find_entry(option, name);
  return entry == nullptr ? nullptr : entry->content;
}

void check_algorithm(const std::string& option, const std::string& text) {
  check_name("--" + option, algorithm_name(text), names_for(option));
}

Algorithm read_named(const std::string& option, const std::string& text, const CommonValues& common) {
  check_algorithm(option, text);
  if (const AlgorithmEntry* entry = find_entry(option, algorithm_name(text)))
    check_available("--" + option, *entry);
  const std::vector<Parameter> parameters = parameters_of(option, algorithm_name(text));
  Algorithm algorithm = read_algorithm("--" + option, text, parameters, common, owners_of);
  if (const ContentReader content = content_of(option, algorithm.name))
    algorithm.text = in_context("--" + option + " " + algorithm.name, [&] {
      return text_with_content(text, parameters, content(algorithm.settings));
    });
  return algorithm;
}

void append_once(const std::string& option, const std::string& item, Algorithm algorithm,
                 std::vector<Algorithm>& list) {
  if (std::ranges::count(list, algorithm.text, &Algorithm::text) > 0)
    throw std::invalid_argument("--" + option + ": '" + item + "' is named twice");
  list.push_back(std::move(algorithm));
}

std::vector<Algorithm> read_list(const std::string& option, const std::string& text,
                                 const CommonValues& common, std::vector<std::string>* left_out) {
  std::vector<Algorithm> list;
  for (const std::string& item : expanded(option, text, common, left_out)) {
    append_once(option, item, read_named(option, item, common), list);
  }
  return list;
}

const SceneEntry& scene_row(const Algorithm& scene) { return *find_row(scenes(), scene.name); }

bool names_groups(const Algorithm& scene) {
  const auto names = scene_row(scene).names_groups;
  return names != nullptr && names(scene.settings);
}

std::unique_ptr<StepSolver> make_solver(const Algorithm& solver, const SolveOptions& options,
                                        const StepContext& context) {
  if (std::unique_ptr<StepSolver> ode = make_ode_baseline(solver, context)) return ode;
  if (std::unique_ptr<StepSolver> chosen = make_chosen_kernel_solver(solver, options)) return chosen;
  return make_step_solver(solver, options);
}

bool uses_parts(const Algorithm& solver) { return make_solver(solver, {}, StepContext{})->uses_partition(); }

}  // namespace cleave
