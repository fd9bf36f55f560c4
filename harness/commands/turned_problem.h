// replay --friction: the contacts of a problem file under another friction model, for `replay`, and for
// `verify`, which compares its rows.
#pragma once

#include <string>

#include "harness/files/problem_file.h"

namespace cleave {

// model: one of recorded_friction_models(); empty: as recorded. Where that changes the problem, the file
// takes the model's name and loses its solutions and partitions, which were of another problem. False where
// no contact of a file has friction, so that it stays as recorded. Throws std::invalid_argument with one line
// that begins with the path for contacts that cannot have the model (friction_cone.h).
bool turn_friction(const std::string& path, const std::string& model, ProblemFile& file);

}  // namespace cleave
