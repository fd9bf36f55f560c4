#include "harness/world/contact_memory.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace cleave {
namespace {

// A possible match of contacts of one geom pair.
struct Candidate {
  double distance_m;
  int present;
  int remembered;
  bool operator<(const Candidate& other) const {
    return std::tie(distance_m, present, remembered) <
           std::tie(other.distance_m, other.present, other.remembered);
  }
};

double bounding_box_extent_m(dGeomID geom) {
  dReal box[6];
  dGeomGetAABB(geom, box);
  return std::min({box[1] - box[0], box[3] - box[2], box[5] - box[4]});
}

double least_extent_m(dGeomID geom) {
  dVector3 sides;
  dReal radius, length;
  switch (dGeomGetClass(geom)) {
    case dSphereClass:
      return 2 * dGeomSphereGetRadius(geom);
    case dBoxClass:
      dGeomBoxGetLengths(geom, sides);
      return std::min({sides[0], sides[1], sides[2]});
    case dCapsuleClass:
      dGeomCapsuleGetParams(geom, &radius, &length);
      return 2 * radius;
    case dCylinderClass:
      dGeomCylinderGetParams(geom, &radius, &length);
      return std::min(2 * radius, length);
    case dPlaneClass:
      return std::numeric_limits<double>::infinity();
    default:
      return bounding_box_extent_m(geom);
  }
}

double distance_m(const ContactPoint& a, const ContactPoint& b) {
  return std::hypot(a.position_m[0] - b.position_m[0], a.position_m[1] - b.position_m[1],
                    a.position_m[2] - b.position_m[2]);
}

std::pair<int, int> geom_pair(const ContactPoint& contact) {
  return std::minmax(contact.geom_a, contact.geom_b);
}

// Contact indices sorted by geom pair, and by index within one.
std::vector<int> order_by_pair(std::span<const ContactPoint> contacts) {
  std::vector<int> order(contacts.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int i, int j) { return geom_pair(contacts[i]) < geom_pair(contacts[j]); });
  return order;
}

// The stretch of `order`, starting at `from`, that belongs to one geom pair; advances `from` past it.
std::span<const int> next_pair(std::span<const ContactPoint> contacts, const std::vector<int>& order,
                               std::pair<int, int> pair, std::size_t& from) {
  while (from < order.size() && geom_pair(contacts[order[from]]) < pair) ++from;
  const std::size_t begin = from;
  while (from < order.size() && geom_pair(contacts[order[from]]) == pair) ++from;
  return std::span(order).subspan(begin, from - begin);
}

}  // namespace

ContactMemory::ContactMemory(double tolerance) : tolerance_(tolerance) {
  if (!std::isfinite(tolerance) || tolerance < 0)
    throw std::invalid_argument("match tolerance = " + std::to_string(tolerance) +
                                ", allowed: finite and >= 0");
}

std::vector<int> ContactMemory::match(const OdeWorld& world, std::span<const ContactPoint> contacts) const {
  std::vector<int> continued(contacts.size(), -1);
  std::vector<char> taken(contacts_.size(), 0);
  const std::vector<int> present_order = order_by_pair(contacts);
  const std::vector<int> remembered_order = order_by_pair(contacts_);
  std::vector<Candidate> candidates;
  std::size_t present_from = 0, remembered_from = 0;
  while (present_from < present_order.size()) {
    const auto pair = geom_pair(contacts[present_order[present_from]]);
    const auto present = next_pair(contacts, present_order, pair, present_from);
    const auto remembered = next_pair(contacts_, remembered_order, pair, remembered_from);
    if (remembered.empty()) continue;
    const auto& geoms = world.content().geoms;
    const double reach_m =
        tolerance_ * std::min(least_extent_m(geoms[pair.first]), least_extent_m(geoms[pair.second]));
    candidates.clear();
    for (const int i : present)
      for (const int j : remembered)
        if (const double distance = distance_m(contacts[i], contacts_[j]); distance <= reach_m)
          candidates.push_back({distance, i, j});
    std::sort(candidates.begin(), candidates.end());
    for (const Candidate& candidate : candidates) {
      if (continued[candidate.present] >= 0 || taken[candidate.remembered]) continue;
      continued[candidate.present] = candidate.remembered;
      taken[candidate.remembered] = 1;
    }
  }
  return continued;
}

std::span<const double> ContactMemory::joint_impulse(int joint) const {
  if (joint >= static_cast<int>(joint_impulse_.size())) return {};
  return joint_impulse_[joint];
}

void ContactMemory::remember(std::span<const ContactPoint> contacts, const StepProblem& problem,
                             std::span<const double> impulse) {
  assert(static_cast<int>(impulse.size()) == problem.row_count());
  contacts_.assign(contacts.begin(), contacts.end());
  contact_impulse_.clear();
  joint_impulse_.clear();
  int normal_row = -1;
  for (int r = 0; r < problem.row_count(); ++r) {
    switch (problem.row_kind[r]) {
      case RowKind::bilateral: {
        const std::size_t joint = problem.row_constraint[r];
        if (joint_impulse_.size() <= joint) joint_impulse_.resize(joint + 1);
        joint_impulse_[joint].push_back(impulse[r]);
        break;
      }
      case RowKind::normal:
        normal_row = r;
        contact_impulse_.push_back({impulse[r], 0, 0});
        break;
      case RowKind::friction:
        assert(problem.friction_row[r] == normal_row);
        contact_impulse_.back()[r - normal_row] = impulse[r];
        break;
    }
  }
  assert(contact_impulse_.size() == contacts.size());
}

}  // namespace cleave
