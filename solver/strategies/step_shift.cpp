#include "solver/strategies/step_shift.h"

#include <algorithm>

#include "solver/cone.h"
#include "solver/group_products.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

}  // namespace

// Contacts stand in the order of their rows.
template <class Task>
void StepShift::over_contacts(SolveState& state, const Task& task) {
  const auto row_of = [](const Contact& contact) { return contact.cone->first_row; };
  state.run_over_rows([&](int first, int last, int) {
    auto contact = std::ranges::lower_bound(contacts_, first, {}, row_of);
    for (; contact != contacts_.end() && row_of(*contact) < last; ++contact) task(*contact);
  });
}

void StepShift::linearize(const SolveState& state, std::span<const double> slack_before, Contact& contact) {
  const FrictionCone& cone = *contact.cone;
  const StepProblem& problem = state.step->problem();
  const Vector3d before = load_contact(cone, slack_before), moved = load_contact(cone, state.slack) - before;
  const double t = tangential(before);
  if (!(t > 0)) return;
  for (int k = 1; k < cone.row_count; ++k) {
    const double share = cone.mu * before[k] / t;
    const double* row = problem.jacobian.data() + 12L * (cone.first_row + k);
    for (int c = 0; c < 12; ++c) contact.row[c] += share * row[c];
    contact.change += share * moved[k];
    contact.compliance[k - 1] = share * problem.compliance[cone.first_row + k];
  }
}

void StepShift::begin(SolveState& state, std::span<const double> slack_before, std::span<const char> slides,
                      double accuracy) {
  const std::span<const FrictionCone> cones = state.step->set().cones();
  contacts_.clear();
  for (std::size_t k = 0; k < cones.size(); ++k)
    if (slides[k] != 0) contacts_.push_back({.cone = &cones[k]});
  shift_.begin(contacts_.size());
  wanted_.resize(contacts_.size());
  accuracy_ = accuracy;
  first_apart_ = -1;
  over_contacts(state, [&](Contact& contact) { linearize(state, slack_before, contact); });
}

void StepShift::add_to_right_hand_side(SolveState& state) const {
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    state.f_r[contacts_[k].cone->first_row] -= shift_.change()[k];
}

bool StepShift::is_matched(SolveState& state) {
  const std::span<const int> body = state.step->problem().row_body;
  const double* dv = state.dv.data();
  over_contacts(state, [&](const Contact& contact) {
    const int row = contact.cone->first_row, a = body[2L * row], b = body[2L * row + 1];
    const Vector3d dlambda = load_contact(*contact.cone, state.dlambda);
    const BodyPair both = load_pair(dv + 6L * a, b < 0 ? nullptr : dv + 6L * b);
    wanted_[&contact - contacts_.data()] = contact.change + row_times(contact.row, both) +
                                           contact.compliance[0] * dlambda[1] +
                                           contact.compliance[1] * dlambda[2];
  });
  const double apart = shift_.improve(wanted_);
  if (first_apart_ < 0) first_apart_ = apart;
  return apart <= accuracy_ * first_apart_;
}

}  // namespace cleave
