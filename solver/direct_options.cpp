#include "solver/direct_options.h"

#include "solver/parameters.h"

namespace cleave {

DirectOptions read_direct_options(const SolveOptions& options, const Settings& settings) {
  using namespace parameters;
  std::map<std::string, std::string> values = settings.values();
  for (const Parameter& parameter : {max_iterations(), predictor_sweeps(), reuse_analysis()})
    values.emplace(parameter.name, default_of(parameter));
  const Settings all(std::move(values));
  return {options, all.integer(max_iterations().name), all.integer(predictor_sweeps().name),
          all.flag(reuse_analysis().name)};
}

}  // namespace cleave
