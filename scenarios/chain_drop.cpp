#include "scenarios/chain_drop.h"

#include <algorithm>
#include <cmath>

#include "scenarios/scene_random.h"
#include "scenarios/shapes.h"

namespace cleave {
namespace {

using Vector = std::array<double, 3>;

constexpr double kMass_kg = 1;
constexpr double kRadius_m = 0.05;
constexpr double kLength_m = 0.3;  // between the joints: the cylindrical part, joined links share a round end
constexpr double kHeight_m = 2;    // above the tip of the funnel
constexpr double kRim_m = 0.5;     // least height above the funnel's slope
constexpr double kRowSpacing_m = 0.22;  // shorter than a link, so that one link reaches the next row
constexpr double kJitter_m = 0.03;

// Where the joints and the two free ends lie, in the plane z = 0 about the origin: rows along x, there and
// back, joined by one slanting link. Every joint is set off its row by a random amount.
std::vector<Vector> lay_out(int links, SceneRandom& random) {
  const int row_links = static_cast<int>(std::ceil(std::sqrt(links * kRowSpacing_m / kLength_m)));
  std::vector<Vector> joints{{0, 0, 0}};
  double forward = 1;
  for (int i = 1, in_row = 0, row = 0; i <= links; ++i) {
    const bool turning = in_row == row_links;
    in_row = turning ? 0 : in_row + 1;
    row += turning ? 1 : 0;
    const Vector last = joints.back();
    const double y = row * kRowSpacing_m + random.uniform(-kJitter_m, kJitter_m);
    const double x_step = std::sqrt(kLength_m * kLength_m - (y - last[1]) * (y - last[1]));
    joints.push_back({last[0] + forward * x_step, y, 0});
    if (turning) forward = -forward;
  }
  return joints;
}

// Puts the middle of the layout over the funnel's tip; returns the larger half width.
double centre(std::vector<Vector>& joints) {
  double half_width = 0;
  for (int k = 0; k < 2; ++k) {
    const auto by_axis = [k](const Vector& a, const Vector& b) { return a[k] < b[k]; };
    const auto [low, high] = std::minmax_element(joints.begin(), joints.end(), by_axis);
    const double middle = ((*low)[k] + (*high)[k]) / 2;
    half_width = std::max(half_width, ((*high)[k] - (*low)[k]) / 2);
    for (Vector& joint : joints) joint[k] -= middle;
  }
  return half_width;
}

class ChainDrop : public Scene {
 public:
  SceneContent build(dWorldID world, dSpaceID space, const Settings& settings, std::uint64_t seed) override {
    SceneBuilder builder(world, space);
    SceneRandom random(seed);
    const int links = settings.integer("links");
    const double slope = std::sqrt(0.5);
    builder.add_plane({slope, 0, slope}, 0);
    builder.add_plane({-slope, 0, slope}, 0);
    builder.add_plane({0, slope, slope}, 0);
    builder.add_plane({0, -slope, slope}, 0);

    std::vector<Vector> joints = lay_out(links, random);
    const double height_m = std::max(kHeight_m, centre(joints) + kRim_m);
    dBodyID previous = nullptr;
    for (int i = 0; i < links; ++i) {
      const Vector &a = joints[i], &b = joints[i + 1];
      const Pose pose{{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, height_m},
                      orientation_along({b[0] - a[0], b[1] - a[1], 0})};
      const double mass_kg = i + 1 == links ? settings.number("bob-mass") : kMass_kg;
      const dBodyID link = builder.add_capsule(pose, mass_kg, kRadius_m, kLength_m);
      if (previous != nullptr) builder.add_ball_joint(previous, link, {a[0], a[1], height_m});
      previous = link;
    }
    return builder.take();
  }
};

}  // namespace

std::vector<Parameter> chain_drop_parameters() {
  using Kind = Parameter::Kind;
  return {{"links", Kind::integer, "100", {1, 20000}, {}, "", "number of links"},
          {"bob-mass", Kind::number, "1", {1e-6, 1e9}, {}, "", "kg of the last link; the others have 1 kg"}};
}

std::unique_ptr<Scene> make_chain_drop() { return std::make_unique<ChainDrop>(); }

}  // namespace cleave
