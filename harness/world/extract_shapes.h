// From ODE's geometry to what a problem file keeps for drawing.
#pragma once

#include "harness/base/shapes.h"
#include "harness/world/ode_world.h"

namespace cleave {

// All geoms of the world in their order, at the present positions. Throws std::runtime_error naming the geom
// when it is of a kind that ProblemShapes does not have.
ProblemShapes extract_shapes(const OdeWorld& world);

}  // namespace cleave
