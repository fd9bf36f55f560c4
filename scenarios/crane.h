// A mobile crane that slews with a heavy load on a cable of light links.
#pragma once

#include <memory>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

std::vector<Parameter> crane_parameters();  // --links, --mass-ratio, --slew

std::unique_ptr<Scene> make_crane();

}  // namespace cleave
