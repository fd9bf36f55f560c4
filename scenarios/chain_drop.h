// A chain of capsules on ball joints, laid out level and dropped into a heap.
#pragma once

#include <memory>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

std::vector<Parameter> chain_drop_parameters();  // --links, --bob-mass

std::unique_ptr<Scene> make_chain_drop();

}  // namespace cleave
