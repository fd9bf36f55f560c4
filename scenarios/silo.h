// Boxes laid close on each other in a square pit, about as high as it is wide, and nearly at rest from the
// start.
#pragma once

#include <memory>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

// --bodies, --mass
std::vector<Parameter> silo_parameters();

std::unique_ptr<Scene> make_silo();

}  // namespace cleave
