// Solver `pgs-colored`: projected Gauss-Seidel (gauss_seidel.h) on several threads. A sweep goes through the colours of the
// groups of rows (group_coloring.h) one after another; those of one colour share no dynamic body, so whichever order threads
// visit them in, the bytes are the same. Fratarcangeli, Tibaldo, Pellacini: Vivace, ACM Transactions on Graphics 35(6), 2016,
// section 4, but for the colouring, which is greedy.
#include <algorithm>

#include "solver/baselines/baselines.h"
#include "solver/baselines/iterative_baseline.h"
#include "solver/gauss_seidel.h"
#include "solver/group_coloring.h"

namespace cleave {
namespace {

constexpr int kTaskGroups = 64;  // of one task: about 300 rows of a pile, some microseconds

class PgsColored : public SweepingBaseline {
 public:
  PgsColored(const SolveOptions& options, int sweeps) : SweepingBaseline("pgs-colored", options, sweeps) {}

 private:
  void begin(const PreparedStep& step) override { coloring_.color(step.body_count(), step.groups()); }
  void sweep(const PreparedStep& step, Solution& solution) override {
    for (int color = 0; color < coloring_.color_count(); ++color) visit_color(step, color, solution);
  }

  void visit_color(const PreparedStep& step, int color, Solution& solution) {
    const std::span<const int> groups = coloring_.groups_of(color);
    const int count = static_cast<int>(groups.size());
    tasks().run((count + kTaskGroups - 1) / kTaskGroups, [&](int task) {
      const int last = std::min(count, (task + 1) * kTaskGroups);
      for (int i = task * kTaskGroups; i < last; ++i)
        gauss_seidel_visit(step, step.groups()[groups[i]], LaneSlack{}, WithinBounds{step}, solution.impulse,
                           solution.velocity);
    });
  }

  GroupColoring coloring_;
};

}  // namespace

std::unique_ptr<StepSolver> make_pgs_colored(const SolveOptions& options, const Settings& settings) {
  return std::make_unique<PgsColored>(options, settings.integer("sweeps"));
}

}  // namespace cleave
