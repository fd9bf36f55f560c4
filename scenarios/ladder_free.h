// Boxes that fall side by side and touch nothing: steps without a single row.
#pragma once

#include <memory>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

std::vector<Parameter> ladder_free_parameters();  // --boxes

std::unique_ptr<Scene> make_ladder_free();

}  // namespace cleave
