#include "scenarios/scene.h"

#include <algorithm>
#include <stdexcept>

#include "harness/base/names.h"

namespace cleave {
namespace {

void check_known(const SceneEntry& scene, const std::string& name) {
  std::vector<std::string> known;
  for (const Parameter& parameter : scene.parameters) {
    if (parameter.name == name) return;
    known.push_back("--" + parameter.name);
  }
  throw std::invalid_argument("--" + name + ": scene '" + scene.name +
                              "' has no such option (it has: " + joined(known) + ")");
}

}  // namespace

void check_scene_options(const SceneEntry& scene, const std::map<std::string, std::string>& given) {
  for (const auto& [name, value] : given) check_known(scene, name);
}

Settings make_scene_settings(const SceneEntry& scene, const std::map<std::string, std::string>& given) {
  check_scene_options(scene, given);
  const auto nobody = [](const std::string&) { return std::string(); };
  Settings settings = read_algorithm("--scene", scene.name, scene.parameters, given, nobody).settings;
  scene_content_id(scene, settings);
  return settings;
}

std::string scene_content_id(const SceneEntry& scene, const Settings& settings) {
  return scene.content_id == nullptr ? "" : scene.content_id(settings);
}

}  // namespace cleave
