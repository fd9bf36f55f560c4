// Solver `relax`: projected Gauss-Seidel that leaves what it has after `relaxations` sweeps from zero.
#include <algorithm>

#include "solver/baselines/baselines.h"
#include "solver/baselines/iterative_baseline.h"
#include "solver/gauss_seidel.h"

namespace cleave {
namespace {

class Relax : public IterativeBaseline {
 public:
  Relax(const SolveOptions& options, int relaxations)
      : IterativeBaseline("relax", options), relaxations_(relaxations) {}

 private:
  int iterate(const PreparedStep& step, Solution& solution) override {
    std::ranges::fill(solution.impulse, 0.0);
    step.velocity(solution.impulse, solution.velocity);
    gauss_seidel_sweeps(step, relaxations_, solution.impulse, solution.velocity, stop());
    return relaxations_;
  }

  int relaxations_;
};

}  // namespace

std::unique_ptr<StepSolver> make_relax(const SolveOptions& options, const Settings& settings) {
  return std::make_unique<Relax>(options, settings.integer("relaxations"));
}

}  // namespace cleave
