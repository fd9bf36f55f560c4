#include "scenarios/crane.h"

#include "scenarios/crane_parts.h"

namespace cleave {
namespace {

constexpr double kLoadEdge_m = 1.6;
constexpr double kGround_m = 1;                        // least height of the load above z = 0
constexpr double kSlewAcceleration_rad_per_s2 = 0.05;  // which the motor has force for

class CraneScene : public Scene {
 public:
  SceneContent build(dWorldID world, dSpaceID space, const Settings& settings, std::uint64_t) override {
    SceneBuilder builder(world, space);
    builder.add_plane({0, 0, 1}, 0);
    const double load_kg = kCableLink_kg * settings.number("mass-ratio");
    std::vector<std::string> groups;
    const Crane crane =
        add_crane(builder, {settings.integer("links"), load_kg, kGround_m + kLoadEdge_m}, groups);
    dJointSetHingeParam(crane.slew, dParamVel, settings.number("slew"));
    dJointSetHingeParam(crane.slew, dParamFMax, kSlewAcceleration_rad_per_s2 * crane.slewed_kg_m2);

    std::array<double, 3> middle = crane.hook_m;
    middle[2] -= kLoadEdge_m / 2;
    const dBodyID load = builder.add_box({middle}, load_kg, {kLoadEdge_m, kLoadEdge_m, kLoadEdge_m});
    builder.add_ball_joint(load, crane.last_link, crane.hook_m);
    groups.push_back("cable");
    SceneContent content = builder.take();
    content.body_group = groups;
    return content;
  }
};

}  // namespace

std::vector<Parameter> crane_parameters() {
  using Kind = Parameter::Kind;
  return {{"links", Kind::integer, "100", {1, 20000}, {}, "", "number of links of the cable, 1 kg each"},
          {"mass-ratio", Kind::number, "1e4", {1, 1e9}, {}, "", "kg of the load on the hook"},
          {"slew", Kind::number, "0.1", {0, 10}, {}, "rad/s", "speed that the slewing motor wants, rad/s"}};
}

std::unique_ptr<Scene> make_crane() { return std::make_unique<CraneScene>(); }

}  // namespace cleave
