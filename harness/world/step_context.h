// What a step is made of besides its problem: read by solvers that are ODE itself and by whoever writes a
// step down. One object a simulation, set anew on every step before anyone solves.
#pragma once

#include <span>

#include "harness/world/ode_world.h"

namespace cleave {

struct StepContext {
  const OdeWorld* world = nullptr;  // null where a recorded problem is solved
  std::span<const ContactPoint> contacts;
  double erp = 0, cfm = 0;  // of the run
};

}  // namespace cleave
