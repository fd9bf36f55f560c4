// All that a scene put into the world, as numbers that can be compared bit for bit.
#pragma once

#include <vector>

#include "scenarios/scene.h"

namespace cleave {

// Pose, velocity, gravity, mass and inertia of every body; kind, bodies, anchor and axis of every joint; kind
// and body of every geometry, and the size of boxes, spheres, capsules, cylinders and planes.
std::vector<double> snapshot(const SceneContent& content);

}  // namespace cleave
