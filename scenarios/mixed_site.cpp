#include "scenarios/mixed_site.h"

#include "scenarios/crane_parts.h"
#include "scenarios/rock_pile.h"
#include "scenarios/scene_random.h"

namespace cleave {
namespace {

constexpr double kCell_m = 0.7, kHeight_m = 0.6;
constexpr double kLeastFill = 0.84,
                 kMostFill = 0.88;  // of a cell, along either edge: the cable has room between rocks
constexpr double kPlay_m = 0.005;   // of a rock off the middle of its cell, along x and y
constexpr double kOverlap_m = 1e-7;
constexpr double kGravity_m_per_s2 = 9.81;  // that the hoist is made for
constexpr int kHoistStep = 20;
constexpr double kHoistSpeed_m_per_s = 0.5, kHoistWay_m = 4;
constexpr double kHoistForce_n =
    30e3;  // beyond the weight of hoist and cable; the rock and what lies on it want it
constexpr double kSlewSpeed_rad_per_s = 0.1, kSlewAcceleration_rad_per_s2 = 0.05, kSlewWay_rad = 0.6;

class MixedSite : public Scene {
 public:
  SceneContent build(dWorldID world, dSpaceID space, const Settings& settings, std::uint64_t seed) override {
    SceneBuilder builder(world, space);
    SceneRandom random(seed);
    builder.add_plane({0, 0, 1}, 0);
    std::vector<std::string> groups;
    crane_ = add_crane(builder, {settings.integer("links"), 0, kHeight_m - kOverlap_m}, groups);
    dJointSetSliderParam(crane_.hoist, dParamHiStop, kHoistWay_m);
    dJointSetHingeParam(crane_.slew, dParamLoStop, -kSlewWay_rad);
    dJointSetHingeParam(crane_.slew, dParamHiStop, kSlewWay_rad);
    dJointSetHingeParam(crane_.slew, dParamFMax, kSlewAcceleration_rad_per_s2 * crane_.slewed_kg_m2);
    add_pile(builder, 2 * settings.integer("rings") + 1, settings.numbers("mass"), random);
    groups.resize(builder.body_count(), "pile");
    SceneContent content = builder.take();
    content.body_group = groups;
    return content;
  }

  // Up first; once the rock is out of the pile the crane slews.
  void before_step(int step, const SceneContent&) override {
    if (step == kHoistStep) {
      dJointSetSliderParam(crane_.hoist, dParamVel, kHoistSpeed_m_per_s);
      dJointSetSliderParam(crane_.hoist, dParamFMax, kHoistForce_n + crane_.hung_kg * kGravity_m_per_s2);
    }
    if (dJointGetSliderPosition(crane_.hoist) > kHoistWay_m / 2)
      dJointSetHingeParam(crane_.slew, dParamVel, kSlewSpeed_rad_per_s);
  }

 private:
  // Layers of side x side, (side - 1) x (side - 1), ... 2 x 2 rocks, each over the gaps of the one below and
  // without a rock in the middle, where the cable runs; that of the lowest layer hangs on it.
  void add_pile(SceneBuilder& builder, int side, const std::vector<double>& masses_kg, SceneRandom& random) {
    for (int cells = side, layer = 0; cells >= 2; --cells, ++layer)
      for (int cell = 0; cell < cells * cells; ++cell) {
        const bool in_the_middle = 2 * cell == cells * cells - 1;
        if (in_the_middle && layer > 0) continue;
        const double x = (cell % cells - (cells - 1) / 2.0) * kCell_m;
        const double y = (cell / cells - (cells - 1) / 2.0) * kCell_m;
        const dBodyID rock =
            add_rock(builder, x, y, layer, masses_kg[random.index(masses_kg.size())], random);
        if (in_the_middle) builder.add_ball_joint(rock, crane_.last_link, crane_.hook_m);
      }
  }

  // x, y: from the cable, before the turn with the boom.
  dBodyID add_rock(SceneBuilder& builder, double x, double y, int layer, double mass_kg,
                   SceneRandom& random) {
    const double off_x = random.uniform(-kPlay_m, kPlay_m), off_y = random.uniform(-kPlay_m, kPlay_m);
    Pose pose = turned_with_boom({{x + off_x, y + off_y, 0}});
    pose.position_m[0] += crane_.hook_m[0];
    pose.position_m[1] += crane_.hook_m[1];
    pose.position_m[2] = (layer + 0.5) * kHeight_m - (layer + 1) * kOverlap_m;
    const double x_m = kCell_m * random.uniform(kLeastFill, kMostFill);
    const double y_m = kCell_m * random.uniform(kLeastFill, kMostFill);
    return builder.add_box(pose, mass_kg, {x_m, y_m, kHeight_m});
  }

  Crane crane_;
};

}  // namespace

std::vector<Parameter> mixed_site_parameters() {
  using Kind = Parameter::Kind;
  return {{"links", Kind::integer, "60", {50, 20000}, {}, "", "number of links of the cable, 1 kg each"},
          {"rings", Kind::integer, "2", {1, 3}, {}, "", "rings of rocks about the one that is lifted"},
          pile_mass("100")};
}

std::unique_ptr<Scene> make_mixed_site() { return std::make_unique<MixedSite>(); }

}  // namespace cleave
