// Rocks dropped from a jittered grid into a square pit.
#pragma once

#include <memory>
#include <vector>

#include "scenarios/scene.h"

namespace cleave {

// Problems of this many bodies have some millions of rows.
constexpr int kMostPileBodies = 200000;

// --bodies and --mass of any pile.
Parameter pile_bodies(const char* default_bodies);
Parameter pile_mass(const char* default_mass_kg);

// --bodies, --depth, --rock-shape, --mass. Piles that differ only in defaults are rows of the registry.
std::vector<Parameter> rock_pile_parameters(const char* default_bodies, const char* default_mass_kg);

std::unique_ptr<Scene> make_rock_pile();

}  // namespace cleave
