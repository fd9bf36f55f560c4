#include "harness/experiment/friction.h"

#include <limits>
#include <stdexcept>

#include "harness/experiment/friction_box.h"
#include "harness/experiment/friction_cone.h"

namespace cleave {
namespace {

const Parameter& mu() {
  static const Parameter parameter{.name = "mu",
                                   .kind = Parameter::Kind::number,
                                   .default_value = "0.5",
                                   .range = {0, std::numeric_limits<double>::infinity()},
                                   .help = "friction coefficient"};
  return parameter;
}

const Parameter& friction_force_n() {
  static const Parameter parameter{.name = "friction-force-n",
                                   .kind = Parameter::Kind::number,
                                   .range = {0, std::numeric_limits<double>::infinity()},
                                   .unit = "N",
                                   .help = "largest friction force along a tangent, N"};
  return parameter;
}

const Parameter& bound_sweeps() {
  static const Parameter parameter{.name = "bound-sweeps",
                                   .kind = Parameter::Kind::integer,
                                   .default_value = std::to_string(kBoundSweeps),
                                   .range = {0, 10000},
                                   .help = "Gauss-Seidel sweeps that predict the bounds of friction"};
  return parameter;
}

void set_predicted_bounds(const ExtractOptions& options, StepProblem& problem) {
  predict_friction_bounds(problem, options.bound_sweeps);
}

}  // namespace

std::span<const FrictionModelEntry> friction_models() {
  static const FrictionModelEntry table[] = {
      {{"none", "no friction rows, one row a contact", "-"}, FrictionModel::none},
      {{"constant",
        "bound = h * friction-force-n, whatever the normal impulse",
        "ODE manual, contact mu as a force limit",
        {friction_force_n()}},
       FrictionModel::constant},
      {{"box",
        "bound = mu * normal impulse predicted by bound-sweeps of Gauss-Seidel, then frozen",
        "pyramid of the ODE manual (dContactApprox1) with its bounds frozen",
        {mu(), bound_sweeps()}},
       FrictionModel::box,
       ContactSet::box,
       set_predicted_bounds,
       true},
      {{"box-converged",
        "bound iterated to mu * normal impulse of the solution",
        "fixed point as in Kaufman et al., Staggered Projections, ACM TOG 27(5), 2008",
        {mu(), bound_sweeps()}},
       FrictionModel::box_converged,
       ContactSet::box,
       set_predicted_bounds},
      {{"cone",
        "|friction| <= mu * normal impulse, as a convex problem: what slides lifts off at mu times its speed",
        "Anitescu, Optimization-based simulation of nonsmooth rigid multibody dynamics, Math. Program. 105, "
        "2006",
        {mu()}},
       FrictionModel::cone,
       ContactSet::cone,
       [](const ExtractOptions&, StepProblem& problem) { set_cones(problem); },
       true},
      {{"coulomb",
        "|friction| <= mu * normal impulse, against the sliding direction: Coulomb's law, not convex",
        "de Saxce and Feng, Mathematical and Computer Modelling 28, 1998",
        {mu()}},
       FrictionModel::coulomb,
       ContactSet::coulomb,
       [](const ExtractOptions&, StepProblem& problem) { set_coulomb(problem); },
       true},
  };
  return table;
}

const FrictionModelEntry& friction_model(const std::string& name) {
  for (const FrictionModelEntry& entry : friction_models())
    if (entry.name == name) return entry;
  throw std::logic_error("no friction model of this name: " + name);
}

const FrictionModelEntry& friction_model(FrictionModel model) {
  for (const FrictionModelEntry& entry : friction_models())
    if (entry.model == model) return entry;
  throw std::logic_error("a friction model that is in no table");
}

std::vector<std::string> recorded_friction_models() {
  std::vector<std::string> names;
  for (const FrictionModelEntry& entry : friction_models())
    if (entry.of_recorded) names.push_back(entry.name);
  return names;
}

}  // namespace cleave
