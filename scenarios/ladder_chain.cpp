#include "scenarios/ladder_chain.h"

#include <cmath>
#include <numbers>

#include "scenarios/shapes.h"

namespace cleave {
namespace {

constexpr double kMass_kg = 1;
constexpr double kRadius_m = 0.05;
constexpr double kLength_m = 0.3;  // between the joints; joined links share a round end
constexpr double kGround_m = 1;    // of the bob's lower end above z = 0 when the chain hangs down

class LadderChain : public Scene {
 public:
  SceneContent build(dWorldID world, dSpaceID space, const Settings& settings, std::uint64_t) override {
    SceneBuilder builder(world, space);
    const int links = settings.integer("links");
    const double angle_rad = settings.number("angle") * std::numbers::pi / 180;
    const std::array<double, 3> along{std::sin(angle_rad), 0, -std::cos(angle_rad)};
    const double top_m = links * kLength_m + kGround_m;
    const auto point = [&](double links_down) -> std::array<double, 3> {
      const double s = links_down * kLength_m;
      return {s * along[0], 0, top_m + s * along[2]};
    };
    dBodyID previous = nullptr;  // the first joint holds the chain to the world
    for (int i = 0; i < links; ++i) {
      const double mass_kg = i + 1 == links ? kMass_kg * settings.number("mass-ratio") : kMass_kg;
      const dBodyID link =
          builder.add_capsule({point(i + 0.5), orientation_along(along)}, mass_kg, kRadius_m, kLength_m);
      builder.add_ball_joint(link, previous, point(i));
      previous = link;
    }
    return builder.take();
  }
};

}  // namespace

std::vector<Parameter> ladder_chain_parameters() {
  using Kind = Parameter::Kind;
  return {
      {"links", Kind::integer, "10", {1, 20000}, {}, "", "number of links, the bob among them"},
      {"mass-ratio", Kind::number, "1000", {1, 1e9}, {}, "", "kg of a heavy body; the light ones have 1 kg"},
      {"angle",
       Kind::number,
       "0",
       {0, 80},
       {},
       "",
       "degrees from the level (a plane) or from hanging (a chain)"}};
}

std::unique_ptr<Scene> make_ladder_chain() { return std::make_unique<LadderChain>(); }

}  // namespace cleave
