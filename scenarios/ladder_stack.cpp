#include "scenarios/ladder_stack.h"

#include <cmath>
#include <numbers>

#include "scenarios/shapes.h"

namespace cleave {
namespace {

constexpr double kEdge_m = 1;
constexpr double kMass_kg = 1;
// The golden angle: no two boxes of a stack stand off its axis in the same direction.
constexpr double kTurn_rad = 2.399963229728653;

// What the scenes of this file differ in. Masses from the bottom up.
struct StackPlan {
  std::vector<double> mass_kg;
  double angle_rad = 0;  // of the plane, about the y axis
  int copies = 1;        // how often every box carries its shape
};

using MakePlan = StackPlan (*)(const Settings& settings);

StackPlan equal_boxes(const Settings& settings) {
  return {std::vector<double>(settings.integer("boxes"), kMass_kg)};
}

StackPlan plain_plan(const Settings& settings) {
  StackPlan plan = equal_boxes(settings);
  plan.copies = settings.integer("copies");
  return plan;
}

StackPlan heavy_top_plan(const Settings& settings) {
  StackPlan plan = equal_boxes(settings);
  plan.mass_kg.push_back(kMass_kg * settings.number("mass-ratio"));
  return plan;
}

StackPlan alternating_plan(const Settings& settings) {
  StackPlan plan = equal_boxes(settings);
  for (std::size_t i = 1; i < plan.mass_kg.size(); i += 2) plan.mass_kg[i] *= settings.number("mass-ratio");
  return plan;
}

StackPlan incline_plan(const Settings& settings) {
  StackPlan plan = equal_boxes(settings);
  plan.angle_rad = settings.number("angle") * std::numbers::pi / 180;
  return plan;
}

class LadderStack : public Scene {
 public:
  explicit LadderStack(MakePlan make_plan) : make_plan_(make_plan) {}

  SceneContent build(dWorldID world, dSpaceID space, const Settings& settings, std::uint64_t) override {
    const StackPlan plan = make_plan_(settings);
    // Overlap up to here is not pushed out. Without it a stiff stack would be pushed apart to the last digit,
    // lose contact and fall by g h^2.
    dWorldSetContactSurfaceLayer(world, settings.number("layer-m"));
    const double overlap_m = settings.number("overlap-m"), offset_m = settings.number("offset-m");
    SceneBuilder builder(world, space);
    const double half = plan.angle_rad / 2;
    const std::array<double, 3> up{std::sin(plan.angle_rad), 0, std::cos(plan.angle_rad)};
    for (std::size_t i = 0; i < plan.mass_kg.size(); ++i) {
      const double place = static_cast<double>(i);
      const double height_m = kEdge_m / 2 - overlap_m + place * (kEdge_m - overlap_m);
      const double down_m = offset_m * std::cos(place * kTurn_rad);
      const double side_m = offset_m * std::sin(place * kTurn_rad);
      const Pose pose{{height_m * up[0] + down_m * up[2], side_m, height_m * up[2] - down_m * up[0]},
                      {std::cos(half), 0, std::sin(half), 0}};
      builder.add_box(pose, plan.mass_kg[i], {kEdge_m, kEdge_m, kEdge_m}, plan.copies);
    }
    builder.add_plane(up, 0);
    return builder.take();
  }

 private:
  MakePlan make_plan_;
};

using Kind = Parameter::Kind;

Parameter boxes_parameter(const char* count) {
  return {"boxes", Kind::integer, count, {1, 1000}, {}, "", "number of boxes of 1 kg with edges of 1 m"};
}

Parameter mass_ratio_parameter(const char* ratio) {
  return {
      "mass-ratio", Kind::number, ratio, {1, 1e9}, {}, "", "kg of a heavy body; the light ones have 1 kg"};
}

// What all of them have besides their own: how the boxes touch at the start.
std::vector<Parameter> with_touch(std::vector<Parameter> own) {
  own.push_back(
      {"overlap-m", Kind::number, "1e-7", {0, 1e-6}, {}, "", "m by which faces overlap at the start"});
  own.push_back({"layer-m", Kind::number, "1e-6", {0, 1e-2}, {}, "", "m of overlap that is not pushed out"});
  own.push_back({"offset-m", Kind::number, "0", {0, 0.1}, {}, "", "m by which boxes stand off the axis"});
  return own;
}

}  // namespace

std::vector<Parameter> ladder_stack_parameters() {
  return with_touch({boxes_parameter("10"),
                     {"copies",
                      Kind::integer,
                      "1",
                      {1, 4},
                      {},
                      "",
                      "coincident shapes of every box: contacts reported again"}});
}

std::vector<Parameter> ladder_heavy_top_parameters() {
  return with_touch({boxes_parameter("5"), mass_ratio_parameter("1e6")});
}

std::vector<Parameter> ladder_alternating_parameters() {
  return with_touch({boxes_parameter("10"), mass_ratio_parameter("1000")});
}

std::vector<Parameter> ladder_incline_parameters() {
  return with_touch({boxes_parameter("1"),
                     {"angle",
                      Kind::number,
                      "15",
                      {0, 80},
                      {},
                      "",
                      "degrees from the level (a plane) or from hanging (a chain)"}});
}

std::unique_ptr<Scene> make_ladder_stack() { return std::make_unique<LadderStack>(plain_plan); }
std::unique_ptr<Scene> make_ladder_heavy_top() { return std::make_unique<LadderStack>(heavy_top_plan); }
std::unique_ptr<Scene> make_ladder_alternating() { return std::make_unique<LadderStack>(alternating_plan); }
std::unique_ptr<Scene> make_ladder_incline() { return std::make_unique<LadderStack>(incline_plan); }

}  // namespace cleave
