#include "scenarios/log_tower.h"

#include <algorithm>
#include <cmath>

#include "scenarios/scene_random.h"
#include "scenarios/shapes.h"

namespace cleave {
namespace {

constexpr double kMass_kg = 50;
constexpr double kRadius_m = 0.15;
constexpr double kLength_m = 3;
constexpr double kOverlap_m =
    1e-7;  // between layers: they touch from the first step on, whatever the rounding

constexpr double kBallMass_kg = 500;
constexpr double kBallRadius_m = 0.5;
constexpr double kBallSpeed_m_per_s = 20;
constexpr double kBallGap_m = 0.5;  // between the waiting ball and the tower, and the ground
constexpr double kBallAim =
    0.75;  // of the tower's height: lower and most layers fall, higher and only the top ones do
constexpr double kLeastAngle_rad =
    0.25;  // between the ball's path and the logs of the lowest layer; askew, so that it
constexpr double kMostAngle_rad = 0.35;  // rolls logs of both directions
constexpr int kKnockStep = 60;

struct LogShape {
  const char* name;
  dBodyID (*add)(SceneBuilder&, const Pose&);
};

constexpr LogShape kLogShapes[] = {
    {"capsule",
     [](SceneBuilder& b, const Pose& pose) { return b.add_capsule(pose, kMass_kg, kRadius_m, kLength_m); }},
    {"box",
     [](SceneBuilder& b, const Pose& pose) {
       return b.add_box(pose, kMass_kg, {2 * kRadius_m, 2 * kRadius_m, kLength_m});
     }},
    {"cylinder",
     [](SceneBuilder& b, const Pose& pose) { return b.add_cylinder(pose, kMass_kg, kRadius_m, kLength_m); }},
};

class LogTower : public Scene {
 public:
  SceneContent build(dWorldID world, dSpaceID space, const Settings& settings, std::uint64_t seed) override {
    SceneBuilder builder(world, space);
    const int layers = settings.integer("layers");
    builder.add_plane({0, 0, 1}, 0);
    add_layers(builder, layers, settings.integer("logs"), settings.text("log-shape"));
    add_waiting_ball(builder, layers * 2 * kRadius_m, seed);
    return builder.take();
  }

  void before_step(int step, const SceneContent& content) override {
    if (step != kKnockStep) return;
    const dBodyID ball = content.bodies.back();
    dBodySetGravityMode(ball, 1);
    dBodySetLinearVel(ball, kBallSpeed_m_per_s * std::cos(ball_angle_rad_),
                      kBallSpeed_m_per_s * std::sin(ball_angle_rad_), 0);
  }

 private:
  // The outermost logs lie so that they still rest on the straight part of those below.
  static void add_layers(SceneBuilder& builder, int layers, int logs, const std::string& shape_name) {
    const LogShape& shape = *std::find_if(std::begin(kLogShapes), std::end(kLogShapes),
                                          [&](const LogShape& s) { return s.name == shape_name; });
    const double pitch_m = (kLength_m - 2 * kRadius_m) / (logs - 1);
    for (int layer = 0; layer < layers; ++layer) {
      const double z = kRadius_m + layer * 2 * kRadius_m - (layer + 1) * kOverlap_m;
      for (int log = 0; log < logs; ++log) {
        const double aside = (log - (logs - 1) / 2.0) * pitch_m;
        const bool along_x = layer % 2 == 0;
        shape.add(builder, along_x ? Pose{{0, aside, z}, orientation_along({1, 0, 0})}
                                   : Pose{{aside, 0, z}, orientation_along({0, 1, 0})});
      }
    }
  }

  // The ball is there from the start, so that the number of bodies never changes; it waits without gravity.
  void add_waiting_ball(SceneBuilder& builder, double tower_height_m, std::uint64_t seed) {
    ball_angle_rad_ = SceneRandom(seed).uniform(kLeastAngle_rad, kMostAngle_rad);
    const double x = -(kLength_m / 2 + kRadius_m + kBallRadius_m + kBallGap_m);
    const double z = std::max(kBallAim * tower_height_m, kBallRadius_m + kBallGap_m);
    const dBodyID ball =
        builder.add_sphere(Pose{{x, x * std::tan(ball_angle_rad_), z}}, kBallMass_kg, kBallRadius_m);
    dBodySetGravityMode(ball, 0);
  }

  double ball_angle_rad_ = 0;
};

}  // namespace

std::vector<Parameter> log_tower_parameters() {
  using Kind = Parameter::Kind;
  std::vector<std::string> shapes;
  for (const LogShape& shape : kLogShapes) shapes.push_back(shape.name);
  return {{"layers", Kind::integer, "40", {1, 1000}, {}, "", "number of layers"},
          {"logs", Kind::integer, "5", {2, 10}, {}, "", "logs a layer, 10 lie side by side"},
          {"log-shape", Kind::word, "capsule", {0, 0}, shapes, "", "shape of every log"}};
}

std::unique_ptr<Scene> make_log_tower() { return std::make_unique<LogTower>(); }

}  // namespace cleave
