// Boxes on top of each other on a plane, level or inclined, whose masses make the step hard to solve. All of
// them also have --overlap-m, --layer-m and --offset-m, which say how the boxes touch at the start.
#pragma once

#include <memory>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

std::vector<Parameter> ladder_stack_parameters();  // --boxes, --copies
std::unique_ptr<Scene> make_ladder_stack();

std::vector<Parameter> ladder_heavy_top_parameters();  // --boxes, --mass-ratio
std::unique_ptr<Scene> make_ladder_heavy_top();

std::vector<Parameter> ladder_alternating_parameters();  // --boxes, --mass-ratio
std::unique_ptr<Scene> make_ladder_alternating();

std::vector<Parameter> ladder_incline_parameters();  // --boxes, --angle
std::unique_ptr<Scene> make_ladder_incline();

}  // namespace cleave
