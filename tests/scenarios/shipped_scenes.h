// Every scene as it comes, for tests that run over all of them: one whose content lies in a file comes once
// for each file in scenarios/files.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

struct ShippedScene {
  const SceneEntry* entry;
  std::map<std::string, std::string> given;  // what must be given
  std::string name;                          // "chain_drop", "file_chain_drop"
  bool draws;                                // something in it comes from the seed
};

inline std::string shipped_file(const std::string& name) {
  return std::string(CLEAVE_SOURCE_DIR) + "/scenarios/files/" + name + ".toml";
}

inline std::vector<ShippedScene> shipped_scenes() {
  std::vector<ShippedScene> all;
  for (const SceneEntry& scene : scenes()) {
    const std::string name = scene.name;
    if (name != "file") {
      all.push_back({&scene, {}, name, !name.starts_with("ladder_") && name != "crane"});
      continue;
    }
    for (const auto& file : std::filesystem::directory_iterator(CLEAVE_SOURCE_DIR "/scenarios/files"))
      all.push_back({&scene,
                     {{"path", file.path().string()}},
                     "file_" + file.path().stem().string(),
                     file.path().stem() == "pile"});
  }
  std::ranges::sort(all, {}, &ShippedScene::name);
  return all;
}

// As they stand on a command line.
inline std::vector<std::string> arguments_of(const ShippedScene& scene) {
  std::string text = scene.entry->name;
  for (const auto& [name, value] : scene.given) text += "@" + name + "=" + value;
  return {"--scene", text};
}

}  // namespace cleave
