// Rocks dropped from a jittered grid into a square pit.
#pragma once

#include <memory>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

// --bodies, --rock-shape, --mass. Piles that differ only in defaults are rows of the registry.
std::vector<Parameter> rock_pile_parameters(const char* default_bodies, const char* default_mass_kg);

std::unique_ptr<Scene> make_rock_pile();

}  // namespace cleave
