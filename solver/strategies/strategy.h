// A strategy finds the active set of a step problem: which rows are free (w = 0) and which sit at a bound.
//
// It works on a SolveState and any kernel, and ends with impulses refined to options.target_m_per_s. Adding a
// strategy: one new file in this folder, its make_...() declared below, and one row in registry.cpp.
#pragma once

#include <memory>

#include "harness/base/parameter.h"
#include "solver/solve_state.h"

namespace cleave {

class Strategy {
 public:
  virtual ~Strategy() = default;
  // True when the residual reached the target, or stopped falling below the limit of an exact answer. False
  // leaves the best impulses it has, for the next strategy or as a result that is reported not converged.
  virtual bool run(SolveState& state) = 0;
  // The impulse sets that it takes.
  virtual SetKind takes() const { return SetKind::intervals; }
};

std::unique_ptr<Strategy> make_pivot(const Settings& settings);
std::unique_ptr<Strategy> make_newton(const Settings& settings);
std::unique_ptr<Strategy> make_interior_point(const Settings& settings);
std::unique_ptr<Strategy> make_alternate(const Settings& settings);

}  // namespace cleave
