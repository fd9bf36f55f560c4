// A crane lifts a rock out from under a pile: structured and unstructured constraints in one step.
#pragma once

#include <memory>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

std::vector<Parameter> mixed_site_parameters();  // --links, --rings, --mass

std::unique_ptr<Scene> make_mixed_site();

}  // namespace cleave
