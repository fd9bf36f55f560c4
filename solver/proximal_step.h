// The second resort for rows with little or no compliance, where rounding kept a strategy above the limit.
// The proximal point method solves a sequence of problems that have more of it,
//
//     lambda_{k+1} solves the step problem with  C + delta  in place of  C  and  b + delta lambda_k  in place
//     of  b,
//
// whose slack is w + delta (lambda_{k+1} - lambda_k): once the impulses stop moving, the answer is the one of
// the problem that was asked. Each step contracts by delta / (delta + the least eigenvalue that matters), so
// a few suffice. Impulses end where redundant rows share the load; velocities are unique. Source:
// Rockafellar, "Monotone operators and the proximal point algorithm", SIAM J. Control Optim. 14, 1976.
#pragma once

#include <span>
#include <vector>

#include "solver/prepared_step.h"

namespace cleave {

class ProximalStep {
 public:
  // Copies the problem, adds delta = relative_delta d_r to the rows with less compliance than that, and
  // centres it at the impulses (m), which are along the axes of the set. The tangent rows of a turned box
  // share one delta, that of the larger d_r.
  void begin(const PreparedStep& step, std::span<const double> centre, double relative_delta);

  // b + delta lambda, lambda along the axes: the slack of the copy at these impulses is the slack of the
  // original.
  void recentre(std::span<const double> centre);

  const StepProblem& problem() const { return problem_; }

 private:
  StepProblem problem_;
  ImpulseSet set_;  // of the copy
  std::vector<double> original_rhs_, delta_, in_rows_;
};

}  // namespace cleave
