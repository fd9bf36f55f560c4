// Solver `split-domains`: the parts of the partition sweep their own rows side by side, each with its own
// copy of the velocities of bodies that it shares with others; after every sweep the copies are averaged. A
// row belongs to the part of its first body. Equations and why it converges are in split_sweep.h; with one
// part it is `pgs`.
//
// Source: Iglberger and Ruede, Large-scale rigid body simulations, Multibody System Dynamics 25, 2011, where
// domains are boxes in space on processes of their own, bodies that reach over the border have copies on both
// sides, and what every side's contacts change in their velocities is sent to the owner and added up. What
// differs here:
//
// - Domains are the parts of any partitioner, and the processes are tasks of one.
// - A copy in one of k domains has 1/k of the body's mass (Tonge, Benevolenski and Voroshilov 2012), and
//   copies are averaged. Changes of copies of full mass, added up, overshoot where several domains push one
//   body, and need not converge; the average of split bodies lowers the energy in every sweep. Added-up
//   changes of impulses are the same in both: v = v0 + M^-1 J^T lambda holds after every sweep.
// - Copies meet after each sweep over all rows, contacts and joints alike.
#include <algorithm>

#include "solver/baselines/baselines.h"
#include "solver/baselines/iterative_baseline.h"
#include "solver/split_sweep.h"

namespace cleave {
namespace {

class SplitDomains : public SweepingBaseline {
 public:
  SplitDomains(const SolveOptions& options, const Settings& settings)
      : SweepingBaseline("split-domains", options, settings) {}
  bool uses_partition() const override { return true; }

 private:
  void begin(const PreparedStep& step) override {
    int domains = 0;
    domain_of_group_.clear();
    for (const RowGroup& g : step.groups()) {
      domain_of_group_.push_back(part_of_body()[g.body_a]);
      domains = std::max(domains, domain_of_group_.back() + 1);
    }
    split_.bind(step, domain_of_group_, domains);
  }
  void sweep(const PreparedStep&, Solution& solution) override {
    split_.run(solution.impulse, solution.velocity, tasks());
  }

  SplitSweep split_;
  std::vector<int> domain_of_group_;
};

}  // namespace

std::unique_ptr<StepSolver> make_split_domains(const SolveOptions& options, const Settings& settings) {
  return std::make_unique<SplitDomains>(options, settings);
}

}  // namespace cleave
