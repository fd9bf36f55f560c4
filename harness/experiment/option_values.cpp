#include "harness/experiment/option_values.h"

#include "harness/base/hash.h"
#include "partition/registry.h"
#include "solver/registry.h"

namespace cleave {
namespace {

OptionKind option_kind(const Parameter& parameter) {
  switch (parameter.kind) {
    case Parameter::Kind::integer:
    case Parameter::Kind::number:
      return OptionKind::number;
    case Parameter::Kind::flag:
      return OptionKind::flag;
    default:
      return OptionKind::text;
  }
}

NamedAlgorithm named(const std::string& kind, const Algorithm& algorithm) {
  NamedAlgorithm named{kind, algorithm.text, algorithm.name, {}, {}};
  for (const Parameter& parameter : parameters_of(kind, algorithm.name)) {
    if (parameter.kind == Parameter::Kind::path) continue;
    named.parameters[parameter.name] = algorithm.settings.text(parameter.name);
    named.defaults[parameter.name] = default_of(parameter);
  }
  if (kind != "solver") return named;
  const SolverHalves halves = solver_halves(algorithm.name);
  if (halves.strategy.empty()) return named;
  named.parameters["strategy"] = named.defaults["strategy"] = halves.strategy;
  named.parameters["kernel"] = named.defaults["kernel"] = halves.kernel;
  return named;
}

}  // namespace

std::vector<OptionValue> option_values(const RunOptions& options) {
  std::vector<OptionValue> values;
  for (const OptionSpec& spec : run_option_specs())
    values.push_back({spec.name, spec.kind, spec.get(options), spec.about, spec.in_run_id});
  for (const auto& [parameter, owners, about, in_replay] : common_parameters()) {
    const auto found = options.common.find(parameter.name);
    values.push_back({parameter.name, option_kind(parameter),
                      found != options.common.end() ? found->second : default_of(parameter), about});
  }
  if (!options.scene.name.empty())
    for (const Parameter& parameter : scene_row(options.scene).parameters)
      if (parameter.kind != Parameter::Kind::path)
        values.push_back(
            {parameter.name, OptionKind::text, options.scene.settings.text(parameter.name), About::problem});
  if (!options.at.empty()) values.push_back({"at", OptionKind::text, joined_numbers(options.at)});
  return values;
}

std::vector<NamedAlgorithm> named_algorithms(const RunOptions& options) {
  std::vector<NamedAlgorithm> list;
  for (const Algorithm& algorithm : options.partitioners) list.push_back(named("partitioner", algorithm));
  for (const Algorithm& algorithm : options.refiners) list.push_back(named("refiner", algorithm));
  for (const Algorithm& algorithm : options.solvers) list.push_back(named("solver", algorithm));
  return list;
}

std::string run_id(std::span<const OptionValue> values) {
  Fnv1a64 hash;
  for (const OptionValue& value : values)
    if (value.in_run_id) hash.add(value.name + "=" + value.text + "\n");
  return hex(hash.value());
}

}  // namespace cleave
