// Solver `pgs`: projected Gauss-Seidel over the rows in their natural order, a fixed number of sweeps. The
// iterative baseline: cheap, and honest about what it leaves (status not_converged unless the residual is
// within the limit).
#include <string_view>

#include "solver/baselines/baselines.h"
#include "solver/gauss_seidel.h"
#include "solver/impulse_set.h"

namespace cleave {
namespace {

constexpr std::string_view kName = "pgs";

class Pgs : public StepSolver {
 public:
  Pgs(const SolveOptions& options, int sweeps)
      : sweeps_(sweeps), stop_(options.stop), clock_(options.threads) {}
  bool uses_partition() const override { return false; }

 private:
  std::string refuse_set(const StepProblem& problem) override {
    return find_set_refusal("solver", kName, problem);
  }

  SolveSummary do_solve(const StepProblem& problem, std::span<const int>, Solution& solution) override {
    SolveSummary summary;
    summary.strategy = kName;
    summary.kernel = "-";
    clock_.start();
    {
      StageTimer timer(clock_, Stage::analyze);
      step_.prepare(problem);
    }
    {
      StageTimer timer(clock_, Stage::predict);
      step_.velocity(solution.impulse, solution.velocity);
      gauss_seidel_sweeps(step_, sweeps_, solution.impulse, solution.velocity, stop_);
      summary.iterations = sweeps_;
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

  int sweeps_;
  const std::atomic<bool>* stop_;
  StageClock clock_;
  PreparedStep step_;
  std::vector<double> slack_;
};

}  // namespace

std::unique_ptr<StepSolver> make_pgs(const SolveOptions& options, const Settings& settings) {
  return std::make_unique<Pgs>(options, settings.integer("sweeps"));
}

}  // namespace cleave
