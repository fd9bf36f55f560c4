// A scene that is written in a file instead of C++; FILE_SCENES.md describes the format.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

std::vector<Parameter> file_scene_parameters();  // path

std::unique_ptr<Scene> make_file_scene();

bool file_scene_names_groups(const Settings& settings);

// FNV-1a-64 of the file's bytes, 16 hexadecimal digits. Reads and checks the file: throws
// std::invalid_argument with one line that names file, line and key.
std::string file_scene_content_id(const Settings& settings);

}  // namespace cleave
