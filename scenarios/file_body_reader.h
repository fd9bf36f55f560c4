// Reads one [[body]] table of a scene file.
#pragma once

#include "scenarios/file_description.h"
#include "scenarios/file_table.h"

namespace cleave::scene_file {

constexpr int kMostBodies = 20000;

Bodies read_bodies(const Value& value);

}  // namespace cleave::scene_file
