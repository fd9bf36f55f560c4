// A straight chain of capsules on ball joints with a heavy bob, hanging from a fixed point.
#pragma once

#include <memory>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

std::vector<Parameter> ladder_chain_parameters();  // --links, --mass-ratio, --angle

std::unique_ptr<Scene> make_ladder_chain();

}  // namespace cleave
