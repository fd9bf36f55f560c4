// Contact identity from step to step: which contact of the previous step a contact point continues.
//
// A contact continues the nearest unmatched contact of the same geom pair within a tolerance (a fraction of
// the smaller shape's least extent). It inherits that contact's impulses, for warm starts and for predicted
// friction bounds. Joint rows keep theirs by (joint index, row).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "harness/world/ode_world.h"
#include "solver/step_problem.h"

namespace cleave {

class ContactMemory {
 public:
  // tolerance: fraction of the smaller shape's least extent, finite and >= 0, else std::invalid_argument.
  explicit ContactMemory(double tolerance = 0.05);

  // For every present contact the index of the contact it continues in the remembered step, or -1. Distances
  // are between world positions. Greedy by distance within a geom pair; ties: lowest present index, then
  // lowest remembered index. Least extent: the thickness of a box, sphere, capsule or cylinder, and of the
  // bounding box of other shapes.
  std::vector<int> match(const OdeWorld& world, std::span<const ContactPoint> contacts) const;

  // Remembered impulses (normal, t1, t2) of one contact. Friction rows that were not built count as zero.
  std::array<double, 3> contact_impulse(int remembered_contact) const {
    return contact_impulse_[remembered_contact];
  }

  // Remembered impulses of one joint's rows; empty where the joint had none.
  std::span<const double> joint_impulse(int joint) const;

  // Remembers the contacts of a solved step and their impulses (m) in the row order of `problem`, which was
  // extracted with these contacts.
  void remember(std::span<const ContactPoint> contacts, const StepProblem& problem,
                std::span<const double> impulse);

 private:
  double tolerance_;
  std::vector<ContactPoint> contacts_;
  std::vector<std::array<double, 3>> contact_impulse_;
  std::vector<std::vector<double>> joint_impulse_;  // by joint index
};

}  // namespace cleave
