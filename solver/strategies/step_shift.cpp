#include "solver/strategies/step_shift.h"

#include "solver/cone.h"
#include "solver/group_products.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

}  // namespace

StepShift::Contact StepShift::linearize(const SolveState& state, const FrictionCone& cone,
                                        std::span<const double> slack_before) {
  Contact contact;
  const StepProblem& problem = state.step->problem();
  const Vector3d before = load_contact(cone, slack_before), moved = load_contact(cone, state.slack) - before;
  const double t = tangential(before);
  if (!(t > 0)) return contact;
  for (int k = 1; k < cone.row_count; ++k) {
    const double share = cone.mu * before[k] / t;
    const double* row = problem.jacobian.data() + 12L * (cone.first_row + k);
    for (int c = 0; c < 12; ++c) contact.row[c] += share * row[c];
    contact.change += share * moved[k];
    contact.compliance[k - 1] = share * problem.compliance[cone.first_row + k];
  }
  return contact;
}

void StepShift::begin(SolveState& state, std::span<const double> slack_before, std::span<const char> slides,
                      double accuracy) {
  const std::span<const FrictionCone> cones = state.step->set().cones();
  sliding_.clear();
  for (std::size_t k = 0; k < cones.size(); ++k)
    if (slides[k] != 0) sliding_.push_back(cones[k]);
  shift_.begin(sliding_.size());
  wanted_.resize(sliding_.size());
  contacts_.resize(sliding_.size());
  accuracy_ = accuracy;
  first_apart_ = -1;
  state.run_over_rows([&](int first, int last, int) {
    for (const FrictionCone& cone : cones_between(sliding_, first, last))
      contacts_[&cone - sliding_.data()] = linearize(state, cone, slack_before);
  });
}

void StepShift::add_to_right_hand_side(SolveState& state) const {
  shift_.subtract_change(sliding_, state.f_r);
}

bool StepShift::is_matched(SolveState& state) {
  const std::span<const int> body = state.step->problem().row_body;
  const double* dv = state.dv.data();
  state.run_over_rows([&](int first, int last, int) {
    for (const FrictionCone& cone : cones_between(sliding_, first, last)) {
      const Contact& contact = contacts_[&cone - sliding_.data()];
      const int a = body[2L * cone.first_row], b = body[2L * cone.first_row + 1];
      const Vector3d dlambda = load_contact(cone, state.dlambda);
      const BodyPair both = load_pair(dv + 6L * a, b < 0 ? nullptr : dv + 6L * b);
      wanted_[&cone - sliding_.data()] = contact.change + row_times(contact.row, both) +
                                         contact.compliance[0] * dlambda[1] +
                                         contact.compliance[1] * dlambda[2];
    }
  });
  const double apart = shift_.improve(wanted_);
  if (first_apart_ < 0) first_apart_ = apart;
  return apart <= accuracy_ * first_apart_;
}

}  // namespace cleave
