#include "solver/impulse_set.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "harness/base/larger_or_nan.h"
#include "solver/cone_lanes.h"

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

FrictionCone cone_of(const StepProblem& problem, int normal) {
  const bool two_tangents = normal + 2 < problem.row_count() && problem.friction_row[normal + 2] == normal;
  return {normal, two_tangents ? 3 : 2, problem.friction_coefficient[normal + 1],
          problem.contact_set[normal] == ContactSet::coulomb};
}

double interval_residual(const StepProblem& problem, int first, int last, std::span<const double> d,
                         std::span<const double> impulse, std::span<const double> w) {
  double worst = 0;
  for (int r = first; r < last; ++r) {
    const double target = std::clamp(impulse[r] - w[r] / d[r], problem.lower[r], problem.upper[r]);
    const double miss = d[r] * std::abs(impulse[r] - target);
    if (!(miss <= worst)) worst = miss;  // a NaN must not pass unseen
    if (std::isnan(worst)) return worst;
  }
  return worst;
}

// visit(misses, d) for the contacts, four at a time: the lanes of ContactLanes.
template <class Visit>
void visit_cone_misses(std::span<const FrictionCone> cones, std::span<const double> d,
                       std::span<const double> impulse, std::span<const double> w, const Visit& visit) {
  while (!cones.empty()) {
    const ContactLanes four(cones);
    const Lanes of_four = four.load_normal(d);
    visit(largest_cone_residual(four.mu, of_four, four.load(impulse), four.load(w)), of_four);
    cones = cones.subspan(four.count);
  }
}

}  // namespace

void ImpulseSet::bind(const StepProblem& problem) {
  problem_ = &problem;
  axes_.clear();
  cones_.clear();
  for (std::size_t r = 0; r < problem.contact_set.size(); ++r) {
    if (problem.contact_set[r] != ContactSet::box) cones_.push_back(cone_of(problem, static_cast<int>(r)));
  }
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

std::span<const FrictionCone> cones_between(std::span<const FrictionCone> cones, int first, int last) {
  const auto begin = std::ranges::lower_bound(cones, first, {}, &FrictionCone::first_row);
  return {begin, std::ranges::lower_bound(begin, cones.end(), last, {}, &FrictionCone::first_row)};
}

void ImpulseSet::project(int first, int last, std::span<double> impulse) const {
  visit_intervals(first, last, [&](int begin, int end) {
    for (int r = begin; r < end; ++r) {
      impulse[r] = std::clamp(impulse[r], problem_->lower[r], problem_->upper[r]);
    }
  });
  for (const FrictionCone& cone : cones_of(first, last))
    store_contact(cone, project_on_cone(load_contact(cone, impulse), cone.mu), impulse);
}

double ImpulseSet::residual(int first, int last, std::span<const double> d, std::span<const double> impulse,
                            std::span<const double> w) const {
  double worst = 0;
  visit_intervals(first, last, [&](int begin, int end) {
    worst = larger_or_nan(worst, interval_residual(*problem_, begin, end, d, impulse, w));
  });
  visit_cone_misses(cones_of(first, last), d, impulse, w, [&](const Lanes& misses, const Lanes&) {
    worst = larger_or_nan(worst, misses.maxCoeff<Eigen::PropagateNaN>());
  });
  return worst;
}

ImpulseSet::Misses ImpulseSet::misses(int first, int last, std::span<const double> d,
                                      std::span<const double> impulse, std::span<const double> w) const {
  Misses all;
  visit_intervals(first, last, [&](int begin, int end) {
    for (int r = begin; r < end; ++r) {
      const double miss = interval_residual(*problem_, r, r + 1, d, impulse, w);
      all.largest = larger_or_nan(all.largest, miss);
      all.energy += miss * miss / d[r];
    }
  });
  visit_cone_misses(cones_of(first, last), d, impulse, w, [&](const Lanes& misses, const Lanes& of_four) {
    all.largest = larger_or_nan(all.largest, misses.maxCoeff<Eigen::PropagateNaN>());
    all.energy += (misses * misses / of_four).sum();
  });
  return all;
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
