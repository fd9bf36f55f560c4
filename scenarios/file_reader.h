// Reads a scene file: all of it is checked before anything is built.
#pragma once

#include <string>

#include "scenarios/file_description.h"

namespace cleave::scene_file {

// name: how errors call the file. Throws std::invalid_argument with one line "pile.toml:7: body.mass_kg:
// ...".
Description parse(const std::string& text, const std::string& name);

// Reads the file when it is first asked for and never again: every world of a process is built from what was
// checked, even where the file changes meanwhile. Throws as parse() does, and where the file cannot be read.
const Description& description_of(const std::string& path);

}  // namespace cleave::scene_file
