#include "solver/impulse_set.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace cleave {
namespace {

// The first row of that kind, or the number of rows.
std::size_t first_turned(const StepProblem& problem) {
  const auto turned = [](double angle) { return angle != 0; };
  return std::ranges::find_if(problem.box_angle_rad, turned) - problem.box_angle_rad.begin();
}

std::size_t first_cone(const StepProblem& problem) {
  const auto no_box = [](ContactSet set) { return set != ContactSet::box; };
  return std::ranges::find_if(problem.contact_set, no_box) - problem.contact_set.begin();
}

}  // namespace

void ImpulseSet::bind(const StepProblem& problem) {
  problem_ = &problem;
  axes_.clear();
  for (std::size_t r = 0; r < problem.box_angle_rad.size(); ++r) {
    const double angle = problem.box_angle_rad[r];
    if (angle == 0) continue;
    const double c = std::cos(angle), s = std::sin(angle);
    axes_.push_back({static_cast<int>(r), 3, {1, 0, 0, 0, c, s, 0, -s, c}});
  }
}

std::span<const double> ImpulseSet::in_rows(std::span<const double> x, std::vector<double>& scratch) const {
  if (axes_.empty()) return x;
  scratch.assign(x.begin(), x.end());
  to_rows(scratch);
  return scratch;
}

void ImpulseSet::project(std::span<double> impulse) const {
  for (std::size_t r = 0; r < impulse.size(); ++r) {
    impulse[r] = std::clamp(impulse[r], problem_->lower[r], problem_->upper[r]);
  }
}

double ImpulseSet::residual(int first, int last, std::span<const double> d, std::span<const double> impulse,
                            std::span<const double> w) const {
  double worst = 0;
  for (int r = first; r < last; ++r) {
    const double target = std::clamp(impulse[r] - w[r] / d[r], problem_->lower[r], problem_->upper[r]);
    const double miss = d[r] * std::abs(impulse[r] - target);
    if (!(miss <= worst)) worst = miss;  // a NaN must not pass unseen
    if (std::isnan(worst)) return worst;
  }
  return worst;
}

SetKind hardest_set(const StepProblem& problem) {
  if (first_cone(problem) < problem.contact_set.size()) return SetKind::cones;
  return first_turned(problem) < problem.box_angle_rad.size() ? SetKind::turned_boxes : SetKind::intervals;
}

std::string find_set_refusal(std::string_view kind, std::string_view name, const StepProblem& problem,
                             SetKind taken) {
  const SetKind hardest = hardest_set(problem);
  if (hardest <= taken) return {};
  std::ostringstream text;
  text << kind << " " << name << " takes "
       << (taken == SetKind::intervals ? "an interval for every row" : "boxes, turned or not");
  if (hardest == SetKind::cones) {
    const std::size_t row = first_cone(problem);
    text << ", not a contact with a cone or Coulomb's law: contact_set[" << row
         << "] = " << static_cast<int>(problem.contact_set[row]) << ", allowed: 0";
  } else {
    const std::size_t row = first_turned(problem);
    text << ", not a box turned in its tangent plane: box_angle_rad[" << row
         << "] = " << problem.box_angle_rad[row] << ", allowed: 0 (strategy interior-point takes others)";
  }
  return text.str();
}

}  // namespace cleave
