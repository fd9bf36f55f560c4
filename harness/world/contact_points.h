// Where geoms touch: near pairs in a fixed order, and ODE's contact points of each.
#pragma once

#include <ode/ode.h>

#include <array>
#include <span>
#include <vector>

namespace cleave {

// One contact point. body_a is the lower body index and always dynamic; body_b is the other one or -1 for
// static geometry; geom_a and geom_b are theirs. The normal points into body_a's side as ODE defines it (a
// body at geom_a moved along the normal leaves geom_b). dCollide is always called with the geom of lower
// index first; where that is not geom_a, its normal is turned round.
struct ContactPoint {
  int geom_a = -1, geom_b = -1;
  int body_a = -1, body_b = -1;
  std::array<double, 3> position_m{};  // world
  std::array<double, 3> normal{};      // world, unit
  double depth_m = 0;                  // > 0 when overlapping
};

// All contact points of the present positions, sorted by (lower body, other body or -1, lower geom, other
// geom, order of dCollide called with the lower geom first). At most contact_cap points a geom pair, in [1,
// 65535], else std::invalid_argument; cap_hits (may be null) counts the pairs that reached it. Bodies joined
// by a joint do not collide. Throws std::runtime_error for a contact or a geom that is not finite. Never call
// from two threads.
std::vector<ContactPoint> find_contact_points(std::span<const dGeomID> geoms, int contact_cap, int* cap_hits);

}  // namespace cleave
