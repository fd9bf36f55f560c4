// Solver `jacobi-split`: mass splitting. All pairs of bodies that share rows are solved side by side, each
// once over its rows, on copies of its two bodies that have a share of their mass; then the copies of every
// body are averaged. Equations and why it converges are in split_sweep.h.
//
// Source: Tonge, Benevolenski and Voroshilov, ACM Transactions on Graphics 31(4), 2012: a body of k blocks of
// contacts is k bodies of 1/k of its mass, and a block is what lies between two bodies. Theirs has contacts
// alone; here rows of joints are blocks like others. A run of rows between two bodies is a block, as the step
// lists them: two constraints between the same bodies with others between them are two blocks.
#include <numeric>

#include "solver/baselines/baselines.h"
#include "solver/baselines/iterative_baseline.h"
#include "solver/split_sweep.h"

namespace cleave {
namespace {

class JacobiSplit : public SweepingBaseline {
 public:
  JacobiSplit(const SolveOptions& options, const Settings& settings)
      : SweepingBaseline("jacobi-split", options, settings) {}

 private:
  void begin(const PreparedStep& step) override {
    domain_of_group_.resize(step.groups().size());
    std::iota(domain_of_group_.begin(), domain_of_group_.end(), 0);
    split_.bind(step, domain_of_group_, static_cast<int>(domain_of_group_.size()));
  }
  void sweep(const PreparedStep&, Solution& solution) override {
    split_.run(solution.impulse, solution.velocity, tasks());
  }

  SplitSweep split_;
  std::vector<int> domain_of_group_;
};

}  // namespace

std::unique_ptr<StepSolver> make_jacobi_split(const SolveOptions& options, const Settings& settings) {
  return std::make_unique<JacobiSplit>(options, settings);
}

}  // namespace cleave
