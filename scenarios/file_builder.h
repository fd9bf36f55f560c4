// Puts what a scene file says into a world.
#pragma once

#include "scenarios/file_description.h"
#include "scenarios/scene.h"
#include "scenarios/scene_random.h"

namespace cleave::scene_file {

// Static planes first, then the bodies and then the joints in the order of the file. For every body are
// drawn, in this order: position, orientation, size, mass, velocity, angular velocity. hulls keeps what ODE
// reads later.
SceneContent build(const Description& scene, dWorldID world, dSpaceID space, SceneRandom& random,
                   Hulls& hulls);

}  // namespace cleave::scene_file
