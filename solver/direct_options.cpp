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
                                   .help = "sweeps over all rows, or iterations, of the iterative baselines",
                                   .source = "Catto 2005"};
  return parameter;
}

const Parameter& until() {
  static const Parameter parameter{
      .name = "until",
      .kind = Kind::number,
      .default_value = "0",
      .range = {0, kInfinity},
      .unit = "m/s",
      .help =
          "residual, over max(1, largest |v0|), at which an iterative baseline "
          "ends before its last sweep; 0: never, but for apgd at the solvers' target",
      .source = "solver/baselines/iterative_baseline.h"};
  return parameter;
}

const Parameter& order() {
  static const Parameter parameter{.name = "order",
                                   .kind = Kind::word,
                                   .default_value = "natural",
                                   .words = {"natural", "random", "height", "propagation"},
                                   .help = "order in which pgs visits constraints",
                                   .source = "solver/baselines/constraint_order.h"};
  return parameter;
}

const Parameter& order_seed() {
  static const Parameter parameter{.name = "order-seed",
                                   .kind = Kind::integer,
                                   .default_value = "1",
                                   .range = {0, kInfinity},
                                   .help = "seed of the dice of order=random"};
  return parameter;
}

const Parameter& coloring() {
  static const Parameter parameter{
      .name = "coloring",
      .kind = Kind::word,
      .default_value = "greedy",
      .words = {"greedy", "vivace"},
      .help = "how pgs-colored finds colours: one group after another, or by chance",
      .source = "solver/group_coloring.h"};
  return parameter;
}

const Parameter& coloring_seed() {
  static const Parameter parameter{.name = "coloring-seed",
                                   .kind = Kind::integer,
                                   .default_value = "1",
                                   .range = {0, kInfinity},
                                   .help = "seed of the dice of coloring=vivace"};
  return parameter;
}

const Parameter& lemke_max_rows() {
  static const Parameter parameter{
      .name = "lemke-max-rows",
      .kind = Kind::integer,
      .default_value = "500",
      .range = {0, kInfinity},
      .help = "rows above which lemke refuses a step: its time grows with their cube",
      .source = "solver/baselines/lemke.cpp"};
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
