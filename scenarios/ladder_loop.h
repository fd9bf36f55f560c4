// A ring of capsules on hinges with parallel axes, hanging from a fixed point in a plane aligned with no
// axis.
#pragma once

#include <memory>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

std::vector<Parameter> ladder_loop_parameters();  // --links

std::unique_ptr<Scene> make_ladder_loop();

}  // namespace cleave
