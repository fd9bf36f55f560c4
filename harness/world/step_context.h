// What a step is made of besides its problem: read by solvers that are ODE itself, by partitioners that go by
// positions or groups and by whoever writes a step down. One object a simulation, set anew on every step
// before anyone solves.
#pragma once

#include <span>
#include <vector>

#include "harness/world/ode_world.h"

namespace cleave {

struct StepContext {
  const OdeWorld* world = nullptr;  // null where a recorded problem is solved
  std::span<const ContactPoint> contacts;
  double erp = 0, cfm = 0;              // of the run
  std::vector<double> position_m = {};  // (n, 3) centres of the bodies; empty where nobody knows them
  std::vector<int> body_group = {};     // (n) numbers of groups that the scene names, -1 for none; or empty
};

}  // namespace cleave
