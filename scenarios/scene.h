// A scene fills an ODE world with bodies, geometry and joints, and may act on it between steps.
//
// scenarios/ knows ODE and harness/base. To add a scene: a new file and a row in registry.cpp; its parameters
// appear on the command line, in `cleave list scenes`, in the manifest and in the tests by themselves.
#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "harness/base/algorithm.h"

namespace cleave {

// What a scene put into the world, in creation order. Indices into these lists are the only identities used
// outside (addresses never are).
struct SceneContent {
  std::vector<dBodyID> bodies;
  std::vector<dGeomID> geoms;    // of bodies and static ones
  std::vector<dJointID> joints;  // permanent joints (contacts are not in here)
  // Corners (k, 3) of convex geoms in their own frames, by geom index; ODE does not give them back. Valid as
  // long as the scene lives.
  std::map<int, std::span<const dReal>> convex_corners;
  // Name of the group that each body belongs to ("" for none); empty for a scene that names no groups.
  std::vector<std::string> body_group;
};

class Scene {
 public:
  virtual ~Scene() = default;
  // Builds into an empty world. seed: every random choice comes from it. The caller owns world and space and
  // destroys them with everything in them.
  virtual SceneContent build(dWorldID world, dSpaceID space, const Settings& settings,
                             std::uint64_t seed) = 0;
  // Called before step number `step` (0, 1, ...) is collided: scripted events such as a ball that is let go.
  virtual void before_step(int /*step*/, const SceneContent& /*content*/) {}
};

struct SceneEntry : AlgorithmEntry {
  std::unique_ptr<Scene> (*make)();
  bool (*names_groups)(const Settings& settings) = nullptr;  // whether bodies are in groups; null: none are
};

std::span<const SceneEntry> scenes();

// Throws std::invalid_argument for an option that the scene does not have, naming those it has.
void check_scene_options(const SceneEntry& scene, const std::map<std::string, std::string>& given);

// Completes given values with the scene's defaults and checks them. Throws std::invalid_argument with one
// line naming the option, the value and the allowed range or choices; an option the scene does not have names
// those it has.
Settings make_scene_settings(const SceneEntry& scene, const std::map<std::string, std::string>& given);

// A fingerprint of what lies outside the program, wherever it lies: 16 hexadecimal digits of the bytes of the
// file that the settings name, "" for a scene without a file. Reads and checks all of it; throws
// std::invalid_argument with one line.
std::string scene_content_id(const SceneEntry& scene, const Settings& settings);

}  // namespace cleave
