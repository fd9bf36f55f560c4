// Worlds for tests: a few bodies made by a function, or a scene by its name.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "harness/world/ode_world.h"
#include "scenarios/shapes.h"

namespace cleave {

// A scene made by a function, for worlds of a few bodies.
using Build = std::function<void(dWorldID, dSpaceID, SceneContent&)>;
inline Build current_build;

class BuiltScene : public Scene {
 public:
  SceneContent build(dWorldID world, dSpaceID space, const Settings&, std::uint64_t) override {
    SceneContent content;
    current_build(world, space, content);
    return content;
  }
};

inline std::unique_ptr<OdeWorld> make_world(Build build, double gravity = 9.81) {
  current_build = std::move(build);
  const SceneEntry entry{{"test", "", ""}, [] { return std::unique_ptr<Scene>(new BuiltScene); }};
  return std::make_unique<OdeWorld>(entry, make_scene_settings(entry, {}), 1, gravity);
}

inline std::unique_ptr<OdeWorld> make_world(const std::function<void(SceneBuilder&)>& build) {
  return make_world([build](dWorldID world, dSpaceID space, SceneContent& content) {
    SceneBuilder builder(world, space);
    build(builder);
    content = builder.take();
  });
}

inline std::unique_ptr<OdeWorld> make_world(const std::string& scene,
                                            const std::map<std::string, std::string>& given,
                                            std::uint64_t seed) {
  for (const SceneEntry& entry : scenes())
    if (scene == entry.name)
      return std::make_unique<OdeWorld>(entry, make_scene_settings(entry, given), seed, 9.81);
  throw std::logic_error(scene);
}

}  // namespace cleave
