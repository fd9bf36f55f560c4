// How the interior-point iteration ends: attempts at an answer from impulses that are nearly right.
//
// Of bounds the active set can be read off once the error is small (s against z), and an exact solve on that
// set has the accuracy of a pivoting method. Cones have no such set; the semi-smooth Newton method of
// cone_newton.h ends their iteration. Under Coulomb's law that may come nearer than the iteration itself and
// still not be there: the nearest is kept, and the method of alart_curnier.h comes last.
#pragma once

#include <limits>
#include <vector>

#include "solver/solve_state.h"
#include "solver/strategies/alart_curnier.h"
#include "solver/strategies/cone_newton.h"
#include "solver/strategies/interior_constants.h"
#include "solver/strategies/interior_iterate.h"

namespace cleave {

class InteriorEnd {
 public:
  explicit InteriorEnd(const InteriorConstants& constants) : constants_(constants) {}

  // Of a step; the present impulses are those of the step before.
  void begin(const SolveState& state);

  // The error, in units of the velocity scale, below which the first attempt pays.
  double first_error(const SolveState& state) const;

  // From the present impulses, which are restored on failure. True where the residual is within the limit.
  bool attempt(SolveState& state, const InteriorIterate& iterate);
  // From the best iterate; on failure the present impulses are restored.
  bool attempt_from_best(SolveState& state, const InteriorIterate& iterate);

  // When the iteration has ended: where its best impulses are not within the limit, what an attempt came
  // nearer with, or comes with now.
  bool last_resort(SolveState& state);

 private:
  bool solve_cones(SolveState& state, double tolerance);
  bool solve_rows(SolveState& state, const InteriorIterate& iterate, double tolerance);

  InteriorConstants constants_;
  ConeNewton newton_;
  AlartCurnier last_;
  bool has_cones_ = false, has_coulomb_ = false;
  std::vector<double> kept_impulse_, present_impulse_, warm_impulse_;
  std::vector<double> law_impulse_;  // of the attempts under Coulomb's law, those of the least residual
  double least_law_residual_ = std::numeric_limits<double>::infinity();
};

}  // namespace cleave
