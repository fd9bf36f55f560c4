#include "scenarios/crane_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace cleave {
namespace {

using Vector = std::array<double, 3>;

constexpr double kOverlap_m = 1e-7;  // of feet and ground, so that contacts exist from the first step on
constexpr double kOutrigger_kg = 500, kOutriggerRadius_m = 0.3;
constexpr double kOutriggerRoot_m[] = {3, 1}, kFoot_m[] = {6, 6};  // along x and y, to either side
constexpr double kChassis_kg = 50e3, kChassisMiddle_m = 1.5;
constexpr Vector kChassisEdges_m = {8, 3, 1};
constexpr double kTurntable_kg = 5e3, kTurntableRadius_m = 1.4, kTurntableHeight_m = 0.6,
                 kTurntableMiddle_m = 2.3;
constexpr Vector kCounterweight_m = {-6, 0, 3.4}, kCounterweightEdges_m = {2.4, 2.4, 2};
constexpr double kBalanced = 0.8;  // share of the moments ahead of the axis that the counterweight balances
constexpr double kMast_kg = 2e3, kMastRadius_m = 0.25;
constexpr Vector kMastBase_m = {-1, 0, 2.9};
constexpr int kSections = 6;
constexpr Vector kBoomFoot_m = {1.2, 0, 3.1};
constexpr double kBoomAngle_rad = 70 * std::numbers::pi / 180;
constexpr double kBoomWidth_m = 0.8, kBoom_kg_per_m = 100, kLeastBoom_m = 20;
constexpr int kPendantLinks = 8;
constexpr double kPendantLink_kg = 60, kPendantRadius_m = 0.08;
constexpr double kMastTop_m[] = {-0.12, 0.3};  // of the boom's length, about, from its foot along x and z
constexpr double kAhead_m = 2;                 // of the tip: the hoist
constexpr double kHoist_kg = 200, kHoistEdge_m = 0.6;
constexpr double kLeastHeight_m =
    1e-9;  // of the hoist's stop above where it stands: it is at the stop from the start

Vector along(const Vector& from, const Vector& direction, double distance_m) {
  return {from[0] + distance_m * direction[0], from[1] + distance_m * direction[1],
          from[2] + distance_m * direction[2]};
}

Vector turned(const Vector& point) { return turned_with_boom({point}).position_m; }

class CraneBuilder {
 public:
  CraneBuilder(SceneBuilder& builder, const CraneDesign& design, std::vector<std::string>& groups)
      : builder_(builder), design_(design), groups_(groups) {
    const double sine = std::sin(kBoomAngle_rad), cosine = std::cos(kBoomAngle_rad);
    const double hoist_m = design.hook_m + design.links * kCableLink_m + kHoistEdge_m / 2;
    boom_m_ = std::max(kLeastBoom_m, (hoist_m - kBoomFoot_m[2]) / sine);
    boom_ = {cosine, 0, sine};
    tip_ = along(kBoomFoot_m, boom_, boom_m_);
    hoist_ = {tip_[0] + kAhead_m, 0, tip_[2]};
    crane_.hung_kg = kHoist_kg + design.links * kCableLink_kg + design.load_kg;
  }

  Crane build() {
    add_chassis();
    name_group("chassis");
    add_turntable();
    add_boom();
    add_pendant();
    add_hoist();
    name_group("boom");
    add_cable();
    name_group("cable");
    crane_.slewed_kg_m2 = crane_.hung_kg * hoist_[0] * hoist_[0] + boom_kg() * tip_[0] * tip_[0] / 3 +
                          counterweight_kg() * kCounterweight_m[0] * kCounterweight_m[0];
    return crane_;
  }

 private:
  double boom_kg() const { return boom_m_ * kBoom_kg_per_m; }

  double counterweight_kg() const {
    const double boom_middle_m = (kBoomFoot_m[0] + tip_[0]) / 2;
    return kBalanced * (boom_kg() * boom_middle_m + crane_.hung_kg * hoist_[0]) / -kCounterweight_m[0];
  }

  void name_group(const char* name) { groups_.resize(builder_.body_count(), name); }

  dBodyID add_rod(const Vector& from, const Vector& to, double mass_kg, double radius_m) {
    const Vector way = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const Pose pose{along(from, way, 0.5), orientation_along(way)};
    const double length_m = std::hypot(way[0], way[1], way[2]);
    return builder_.add_capsule(turned_with_boom(pose), mass_kg, radius_m, length_m);
  }

  // The chassis does not slew: it is square to the axes of the world.
  void add_chassis() {
    chassis_ = builder_.add_box({{0, 0, kChassisMiddle_m}}, kChassis_kg, kChassisEdges_m);
    for (const double x : {-1.0, 1.0})
      for (const double y : {-1.0, 1.0}) {
        const Vector root{x * kOutriggerRoot_m[0], y * kOutriggerRoot_m[1], kChassisMiddle_m};
        const Vector way{x * (kFoot_m[0] - kOutriggerRoot_m[0]), y * (kFoot_m[1] - kOutriggerRoot_m[1]),
                         kOutriggerRadius_m - kOverlap_m - kChassisMiddle_m};
        const dBodyID leg =
            builder_.add_capsule({along(root, way, 0.5), orientation_along(way)}, kOutrigger_kg,
                                 kOutriggerRadius_m, std::hypot(way[0], way[1], way[2]));
        builder_.add_fixed_joint(leg, chassis_);
      }
  }

  void add_turntable() {
    turntable_ = builder_.add_cylinder(turned_with_boom({{0, 0, kTurntableMiddle_m}}), kTurntable_kg,
                                       kTurntableRadius_m, kTurntableHeight_m);
    crane_.slew = builder_.add_hinge_joint(turntable_, chassis_, {0, 0, kTurntableMiddle_m}, {0, 0, 1});
    const dBodyID counterweight =
        builder_.add_box(turned_with_boom({kCounterweight_m}), counterweight_kg(), kCounterweightEdges_m);
    builder_.add_fixed_joint(counterweight, turntable_);
  }

  void add_boom() {
    const double section_m = boom_m_ / kSections;
    dBodyID previous = nullptr;
    for (int i = 0; i < kSections; ++i) {
      const Pose pose{along(kBoomFoot_m, boom_, (i + 0.5) * section_m), orientation_along(boom_)};
      const dBodyID section = builder_.add_box(turned_with_boom(pose), boom_kg() / kSections,
                                               {kBoomWidth_m, kBoomWidth_m, section_m});
      if (previous == nullptr) {
        builder_.add_hinge_joint(section, turntable_, turned(kBoomFoot_m), turned({0, 1, 0}));
      } else {
        builder_.add_fixed_joint(section, previous);
      }
      previous = section;
    }
    last_section_ = previous;
  }

  // From the tip to the mast, which is as high as the pendant wants it.
  void add_pendant() {
    const double run = boom_[0] - kMastTop_m[0], drop = boom_[2] - kMastTop_m[1];  // of the boom's length
    const double slope = drop / run, link_m = std::hypot(run, drop) * boom_m_ / kPendantLinks;
    const double pendant_kg = kPendantLinks * kPendantLink_kg;
    const double across_kg =
        ((boom_kg() + pendant_kg) / 2 * boom_[0] + crane_.hung_kg * (boom_[0] + kAhead_m / boom_m_)) /
        (boom_[2] - slope * boom_[0]);
    double up_kg = -slope * across_kg - pendant_kg / 2;
    Vector from = tip_;
    dBodyID previous = last_section_;
    for (int i = 0; i < kPendantLinks; ++i, up_kg += kPendantLink_kg) {
      const double middle_kg = up_kg + kPendantLink_kg / 2, pull_kg = std::hypot(across_kg, middle_kg);
      const Vector to = along(from, {-across_kg / pull_kg, 0, middle_kg / pull_kg}, link_m);
      const dBodyID link = add_rod(from, to, kPendantLink_kg, kPendantRadius_m);
      builder_.add_ball_joint(link, previous, turned(from));
      previous = link;
      from = to;
    }
    const dBodyID mast = add_rod(kMastBase_m, from, kMast_kg, kMastRadius_m);
    builder_.add_fixed_joint(mast, turntable_);
    builder_.add_ball_joint(mast, previous, turned(from));
  }

  void add_hoist() {
    hoist_body_ =
        builder_.add_box(turned_with_boom({hoist_}), kHoist_kg, {kHoistEdge_m, kHoistEdge_m, kHoistEdge_m});
    crane_.hoist = builder_.add_slider_joint(hoist_body_, last_section_, {0, 0, 1});
    dJointSetSliderParam(crane_.hoist, dParamLoStop, kLeastHeight_m);
  }

  void add_cable() {
    Vector top = {hoist_[0], 0, hoist_[2] - kHoistEdge_m / 2};
    dBodyID previous = hoist_body_;
    for (int i = 0; i < design_.links; ++i) {
      const Vector bottom = along(top, {0, 0, -1}, kCableLink_m);
      const dBodyID link = add_rod(top, bottom, kCableLink_kg, kCableRadius_m);
      builder_.add_ball_joint(link, previous, turned(top));
      previous = link;
      top = bottom;
    }
    crane_.last_link = previous;
    crane_.hook_m = turned(top);
  }

  SceneBuilder& builder_;
  const CraneDesign& design_;
  std::vector<std::string>& groups_;
  Crane crane_;
  double boom_m_ = 0;
  Vector boom_{}, tip_{}, hoist_{};  // direction; points
  dBodyID chassis_ = nullptr, turntable_ = nullptr, last_section_ = nullptr, hoist_body_ = nullptr;
};

}  // namespace

Pose turned_with_boom(const Pose& pose) {
  const double c = std::cos(kCraneAngle_rad), s = std::sin(kCraneAngle_rad);
  const Vector& p = pose.position_m;
  Pose turned{{c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]}, {}};
  const dQuaternion turn{std::cos(kCraneAngle_rad / 2), 0, 0, std::sin(kCraneAngle_rad / 2)};
  dQMultiply0(turned.orientation.data(), turn, pose.orientation.data());
  return turned;
}

Crane add_crane(SceneBuilder& builder, const CraneDesign& design, std::vector<std::string>& groups) {
  return CraneBuilder(builder, design, groups).build();
}

}  // namespace cleave
