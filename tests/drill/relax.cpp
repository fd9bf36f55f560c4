// Solver `relax`: projected Gauss-Seidel that leaves what it has after `relaxations` sweeps from zero.
#include <algorithm>

#include "solver/baselines/baselines.h"
#include "solver/gauss_seidel.h"

namespace cleave {
namespace {

class Relax : public StepSolver {
 public:
  Relax(int threads, int relaxations) : relaxations_(relaxations), clock_(threads) {}
  bool uses_partition() const override { return false; }

 private:
  SolveSummary do_solve(const StepProblem& problem, std::span<const int>, Solution& solution) override {
    SolveSummary summary;
    summary.strategy = "relax";
    summary.kernel = "-";
    clock_.start();
    {
      StageTimer timer(clock_, Stage::analyze);
      step_.prepare(problem);
    }
    {
      StageTimer timer(clock_, Stage::predict);
      std::ranges::fill(solution.impulse, 0.0);
      step_.velocity(solution.impulse, solution.velocity);
      gauss_seidel_sweeps(step_, relaxations_, solution.impulse, solution.velocity);
      summary.iterations = relaxations_;
    }
    slack_.resize(problem.row_count());
    step_.velocity(solution.impulse, solution.velocity);
    step_.slack(solution.velocity, solution.impulse, slack_);
    if (!(step_.residual(solution.impulse, slack_) <= step_.exact_limit_m_per_s())) {
      summary.status = SolveStatus::not_converged;
      summary.message = "residual above the limit after the last sweep";
    }
    summary.times = clock_.stop();
    return summary;
  }

  int relaxations_;
  StageClock clock_;
  PreparedStep step_;
  std::vector<double> slack_;
};

}  // namespace

std::unique_ptr<StepSolver> make_relax(const SolveOptions& options, const Settings& settings) {
  return std::make_unique<Relax>(options.threads, settings.integer("relaxations"));
}

}  // namespace cleave
