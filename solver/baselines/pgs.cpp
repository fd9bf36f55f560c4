// Solver `pgs`: projected Gauss-Seidel (gauss_seidel.h) over constraints in one of several orders
// (constraint_order.h), until its sweeps are made or the residual is small enough. The iterative baseline:
// cheap, and honest about what it leaves (status not_converged unless the residual is within the limit).
#include "solver/baselines/baselines.h"
#include "solver/baselines/constraint_order.h"
#include "solver/baselines/iterative_baseline.h"
#include "solver/gauss_seidel.h"
#include "solver/parameters.h"

namespace cleave {
namespace {

class Pgs : public SweepingBaseline {
 public:
  Pgs(const SolveOptions& options, const Settings& settings)
      : SweepingBaseline("pgs", options, settings),
        order_(settings.word<OrderKind>(parameters::order()), settings.integer("order-seed")) {}

 private:
  void begin(const PreparedStep& step) override { order_.begin(step); }
  void sweep(const PreparedStep& step, Solution& solution) override {
    for (const RowGroup& g : order_.next(step))
      gauss_seidel_visit(step, g, LaneSlack{}, WithinBounds(step), solution.impulse, solution.velocity);
  }

  ConstraintOrder order_;
};

}  // namespace

std::unique_ptr<StepSolver> make_pgs(const SolveOptions& options, const Settings& settings) {
  return std::make_unique<Pgs>(options, settings);
}

}  // namespace cleave
