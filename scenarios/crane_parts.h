// A mobile crane at rest: what the scenes crane and mixed_site have in common.
//
// In the plane of the boom, x forwards and z up, before everything is turned about z by kCraneAngle_rad:
//     chassis      a box on four outriggers (fixed joints), whose round feet touch the ground
//     turntable    on the chassis, hinge about z: the slewing motor; a counterweight and a mast are fixed to
//                  it
//     boom         sections on fixed joints, on a hinge across; a pendant of links holds its tip to the
//                  mast's top
//     hoist        on a slider along z ahead of the tip, resting on its lower stop; the cable hangs from it
//
// The pendant is laid out as it hangs. Its tip pulls the boom with (-H, V), each link of weight w hands on
// (-H, V + w), so the k-th one, k = 1 ..., lies along (-H, V + (k - 1/2) w). With the boom's length L, angle
// a and weight B, what hangs ahead of its tip by d with weight T, n links and a mean slope s of the pendant
// (V = -s H - n w / 2), moments about the boom's foot are in balance for
//     H (sin a - s cos a) = (B + n w) / 2 cos a + T (cos a + d / L).
// Weights are masses here: gravity cancels.
#pragma once

#include <string>
#include <vector>

#include "scenarios/shapes.h"

namespace cleave {

inline constexpr double kCraneAngle_rad = 0.5;  // of the boom, about z
inline constexpr double kCableLink_m = 0.5;     // between joints
inline constexpr double kCableLink_kg = 1;
inline constexpr double kCableRadius_m = 0.03;

struct CraneDesign {
  int links = 0;       // of the cable
  double load_kg = 0;  // hanging from the cable's end, of any other body
  double hook_m = 0;   // least height of the cable's end
};

struct Crane {
  dJointID slew = nullptr;   // hinge, its motor off
  dJointID hoist = nullptr;  // slider, positive upwards, its motor off
  dBodyID last_link = nullptr;
  std::array<double, 3> hook_m{};  // the cable's end
  double hung_kg = 0;              // hoist, cable and load
  double slewed_kg_m2 = 0;         // inertia about the slewing axis, about
};

// Adds the crane and names a group for each of its bodies: chassis, boom (with all that is fixed to it),
// cable.
Crane add_crane(SceneBuilder& builder, const CraneDesign& design, std::vector<std::string>& groups);

// The pose turned about z with the boom.
Pose turned_with_boom(const Pose& pose);

}  // namespace cleave
