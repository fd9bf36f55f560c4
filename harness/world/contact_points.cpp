#include "harness/world/contact_points.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>

#include "harness/world/ode_index.h"
#include "harness/world/overlapping_boxes.h"

namespace cleave {
namespace {

struct GeomPair {
  int body_a, body_b;  // as in ContactPoint
  int lower_geom, other_geom;
  auto key() const { return std::tie(body_a, body_b, lower_geom, other_geom); }
  bool operator<(const GeomPair& other) const { return key() < other.key(); }
};

AxisAlignedBox bounding_box(dGeomID geom) {
  AxisAlignedBox box;
  dGeomGetAABB(geom, box.data());
  if (std::ranges::any_of(box, [](double x) { return std::isnan(x); }))
    throw std::runtime_error("geom " + std::to_string(index_of(geom)) + " is not at a finite place");
  return box;
}

// What ODE's spaces ask of a pair: both switched on, and one of them meant to meet the other.
bool are_set_to_collide(dGeomID a, dGeomID b) {
  if (!dGeomIsEnabled(a) || !dGeomIsEnabled(b)) return false;
  return (dGeomGetCategoryBits(a) & dGeomGetCollideBits(b)) != 0 ||
         (dGeomGetCategoryBits(b) & dGeomGetCollideBits(a)) != 0;
}

bool can_touch(dGeomID first, dGeomID second) {
  const dBodyID first_body = dGeomGetBody(first), second_body = dGeomGetBody(second);
  if (first_body == second_body) return false;  // parts of one body, or both static
  if (!are_set_to_collide(first, second)) return false;
  const bool both_dynamic = first_body != nullptr && second_body != nullptr;
  return !both_dynamic || !dAreConnectedExcluding(first_body, second_body, dJointTypeContact);
}

GeomPair make_pair(dGeomID low, dGeomID high) {
  const auto [low_body, high_body] = std::minmax({index_of(dGeomGetBody(low)), index_of(dGeomGetBody(high))});
  return low_body < 0 ? GeomPair{high_body, -1, index_of(low), index_of(high)}
                      : GeomPair{low_body, high_body, index_of(low), index_of(high)};
}

// Sorted; geoms by their index.
std::vector<GeomPair> find_near_pairs(std::span<const dGeomID> geoms) {
  std::vector<AxisAlignedBox> boxes;
  boxes.reserve(geoms.size());
  for (const dGeomID geom : geoms) boxes.push_back(bounding_box(geom));
  std::vector<GeomPair> pairs;
  for (const auto& [low, high] : overlapping_boxes(boxes))
    if (can_touch(geoms[low], geoms[high])) pairs.push_back(make_pair(geoms[low], geoms[high]));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

ContactPoint make_contact(const GeomPair& pair, bool lower_geom_is_a, const dContactGeom& found) {
  ContactPoint contact{.body_a = pair.body_a, .body_b = pair.body_b, .depth_m = found.depth};
  contact.geom_a = lower_geom_is_a ? pair.lower_geom : pair.other_geom;
  contact.geom_b = lower_geom_is_a ? pair.other_geom : pair.lower_geom;
  bool finite = std::isfinite(found.depth);
  for (int k = 0; k < 3; ++k) {
    contact.position_m[k] = found.pos[k];
    contact.normal[k] = lower_geom_is_a ? found.normal[k] : -found.normal[k];
    finite = finite && std::isfinite(found.pos[k]) && std::isfinite(found.normal[k]);
  }
  if (!finite)
    throw std::runtime_error("contact between geoms " + std::to_string(pair.lower_geom) + " and " +
                             std::to_string(pair.other_geom) + " is not finite");
  return contact;
}

}  // namespace

std::vector<ContactPoint> find_contact_points(std::span<const dGeomID> geoms, int contact_cap,
                                              int* cap_hits) {
  if (contact_cap < 1 || contact_cap > 65535)
    throw std::invalid_argument("contact cap: " + std::to_string(contact_cap) + " is not in [1, 65535]");
  const std::vector<GeomPair> pairs = find_near_pairs(geoms);
  std::vector<ContactPoint> contacts;
  std::vector<dContactGeom> found(contact_cap);
  int hits = 0;
  for (const GeomPair& pair : pairs) {
    const dGeomID lower = geoms[pair.lower_geom], other = geoms[pair.other_geom];
    const int count = dCollide(lower, other, contact_cap, found.data(), sizeof(dContactGeom));
    const bool lower_geom_is_a = index_of(dGeomGetBody(lower)) == pair.body_a;
    for (int i = 0; i < count; ++i) contacts.push_back(make_contact(pair, lower_geom_is_a, found[i]));
    hits += count == contact_cap;
  }
  if (cap_hits != nullptr) *cap_hits = hits;
  return contacts;
}

}  // namespace cleave
