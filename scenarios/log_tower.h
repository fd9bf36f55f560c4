// Layers of parallel logs in alternating directions, at rest until a ball knocks the top off.
#pragma once

#include <memory>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

std::vector<Parameter> log_tower_parameters();  // --layers, --logs, --log-shape

std::unique_ptr<Scene> make_log_tower();

}  // namespace cleave
