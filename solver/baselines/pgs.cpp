// Solver `pgs`: projected Gauss-Seidel over the rows in their natural order, a fixed number of sweeps. The
// iterative baseline: cheap, and honest about what it leaves (status not_converged unless the residual is
// within the limit).
#include "solver/baselines/baselines.h"
#include "solver/baselines/iterative_baseline.h"
#include "solver/gauss_seidel.h"

namespace cleave {
namespace {

class Pgs : public IterativeBaseline {
 public:
  Pgs(const SolveOptions& options, int sweeps) : IterativeBaseline("pgs", options), sweeps_(sweeps) {}

 private:
  int iterate(const PreparedStep& step, Solution& solution) override {
    gauss_seidel_sweeps(step, sweeps_, solution.impulse, solution.velocity, stop());
    return sweeps_;
  }

  int sweeps_;
};

}  // namespace

std::unique_ptr<StepSolver> make_pgs(const SolveOptions& options, const Settings& settings) {
  return std::make_unique<Pgs>(options, settings.integer("sweeps"));
}

}  // namespace cleave
