#include "solver/direct_options.h"

#include <limits>

namespace cleave {
namespace parameters {
namespace {

using Kind = Parameter::Kind;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

const Parameter& max_iterations() {
  static const Parameter parameter{.name = "max-iterations",
                                   .kind = Kind::integer,
                                   .default_value = "100",
                                   .range = {1, kInfinity},
                                   .help = "iterations after which a strategy gives up"};
  return parameter;
}

const Parameter& predictor_sweeps() {
  static const Parameter parameter{
      .name = "predictor-sweeps",
      .kind = Kind::integer,
      .default_value = "80",
      .range = {0, kInfinity},
      .help =
          "most Gauss-Seidel sweeps that the strategy pivot starts from; fewer where "
          "the active set settles",
      .source = "solver/strategies/pivot.cpp"};
  return parameter;
}

const Parameter& reuse_analysis() {
  static const Parameter parameter{
      .name = "reuse-analysis",
      .kind = Kind::flag,
      .default_value = "false",
      .help = "keep a solver's symbolic analysis while parts stay and contacts fit its pattern"};
  return parameter;
}

const Parameter& sweeps() {
  static const Parameter parameter{.name = "sweeps",
                                   .kind = Kind::integer,
                                   .default_value = "5",
                                   .range = {0, kInfinity},
                                   .help = "Gauss-Seidel sweeps of pgs and pgs-colored",
                                   .source = "Catto 2005"};
  return parameter;
}

const Parameter& arity() {
  static const Parameter parameter{
      .name = "arity",
      .kind = Kind::integer,
      .default_value = "2",
      .range = {2, 64},
      .help =
          "parts that a set of bodies is split into, again and again until each has "
          "at most max-bodies",
      .source = "Karypis and Kumar 1998"};
  return parameter;
}

}  // namespace parameters

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
