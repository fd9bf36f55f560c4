#include "scenarios/ladder_stack.h"

#include <cmath>
#include <numbers>

#include "scenarios/shapes.h"

namespace cleave {
namespace {

constexpr double kEdge_m = 1;
constexpr double kMass_kg = 1;
constexpr double kOverlap_m = 1e-7;  // of touching faces, so that contacts exist from the first step on
// Overlap up to here is not pushed out. Without it a stiff stack would be pushed apart to the last digit,
// lose contact and fall by g h^2.
constexpr double kLayer_m = 1e-6;

// What the scenes of this file differ in. Masses from the bottom up.
struct StackPlan {
  std::vector<double> mass_kg;
  double angle_rad = 0;  // of the plane, about the y axis
  int copies = 1;        // how often every box carries its shape
};

using MakePlan = StackPlan (*)(const SceneSettings& settings);

StackPlan equal_boxes(const SceneSettings& settings) {
  return {std::vector<double>(settings.integer("boxes"), kMass_kg)};
}

StackPlan plain_plan(const SceneSettings& settings) {
  StackPlan plan = equal_boxes(settings);
  plan.copies = settings.integer("copies");
  return plan;
}

StackPlan heavy_top_plan(const SceneSettings& settings) {
  StackPlan plan = equal_boxes(settings);
  plan.mass_kg.push_back(kMass_kg * settings.number("mass-ratio"));
  return plan;
}

StackPlan alternating_plan(const SceneSettings& settings) {
  StackPlan plan = equal_boxes(settings);
  for (std::size_t i = 1; i < plan.mass_kg.size(); i += 2) plan.mass_kg[i] *= settings.number("mass-ratio");
  return plan;
}

StackPlan incline_plan(const SceneSettings& settings) {
  StackPlan plan = equal_boxes(settings);
  plan.angle_rad = settings.number("angle") * std::numbers::pi / 180;
  return plan;
}

class LadderStack : public Scene {
 public:
  explicit LadderStack(MakePlan make_plan) : make_plan_(make_plan) {}

  SceneContent build(dWorldID world, dSpaceID space, const SceneSettings& settings, std::uint64_t) override {
    const StackPlan plan = make_plan_(settings);
    dWorldSetContactSurfaceLayer(world, kLayer_m);
    SceneBuilder builder(world, space);
    const double half = plan.angle_rad / 2;
    const std::array<double, 3> up{std::sin(plan.angle_rad), 0, std::cos(plan.angle_rad)};
    for (std::size_t i = 0; i < plan.mass_kg.size(); ++i) {
      const double height_m = kEdge_m / 2 - kOverlap_m + static_cast<double>(i) * (kEdge_m - kOverlap_m);
      const Pose pose{{height_m * up[0], 0, height_m * up[2]}, {std::cos(half), 0, std::sin(half), 0}};
      builder.add_box(pose, plan.mass_kg[i], {kEdge_m, kEdge_m, kEdge_m}, plan.copies);
    }
    builder.add_plane(up, 0);
    return builder.take();
  }

 private:
  MakePlan make_plan_;
};

using Type = SceneParameter::Type;

SceneParameter boxes_parameter(const char* count) {
  return {"boxes", Type::integer, count, 1, 1000, {}, "number of boxes of 1 kg with edges of 1 m"};
}

SceneParameter mass_ratio_parameter(const char* ratio) {
  return {"mass-ratio", Type::number, ratio, 1, 1e9, {}, "kg of a heavy body; the light ones have 1 kg"};
}

}  // namespace

std::vector<SceneParameter> ladder_stack_parameters() {
  return {
      boxes_parameter("10"),
      {"copies", Type::integer, "1", 1, 4, {}, "coincident shapes of every box: contacts reported again"}};
}

std::vector<SceneParameter> ladder_heavy_top_parameters() {
  return {boxes_parameter("5"), mass_ratio_parameter("1e6")};
}

std::vector<SceneParameter> ladder_alternating_parameters() {
  return {boxes_parameter("10"), mass_ratio_parameter("1000")};
}

std::vector<SceneParameter> ladder_incline_parameters() {
  return {
      boxes_parameter("1"),
      {"angle", Type::number, "15", 0, 80, {}, "degrees from the level (a plane) or from hanging (a chain)"}};
}

std::unique_ptr<Scene> make_ladder_stack() { return std::make_unique<LadderStack>(plain_plan); }
std::unique_ptr<Scene> make_ladder_heavy_top() { return std::make_unique<LadderStack>(heavy_top_plan); }
std::unique_ptr<Scene> make_ladder_alternating() { return std::make_unique<LadderStack>(alternating_plan); }
std::unique_ptr<Scene> make_ladder_incline() { return std::make_unique<LadderStack>(incline_plan); }

}  // namespace cleave
