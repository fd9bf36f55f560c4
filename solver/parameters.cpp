#include "solver/parameters.h"

#include <limits>

namespace cleave::parameters {
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
      .default_value = "60",
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

}  // namespace cleave::parameters
