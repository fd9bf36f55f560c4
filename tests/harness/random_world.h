// Scene files drawn at random: bodies of all simple shapes, of masses over four decades, thrown about in a
// pit or above a floor, some joined to another or to the world.
#pragma once

#include <cstdint>
#include <string>

namespace cleave {

// Text of a scene file (scenarios/FILE_SCENES.md). One seed gives one text on every machine.
std::string random_world(std::uint64_t seed);

}  // namespace cleave
