// Solver `pgs-colored`: projected Gauss-Seidel (gauss_seidel.h) on several threads. A sweep goes through the
// colours of the groups of rows one after another (colored_groups.h).
#include "solver/baselines/baselines.h"
#include "solver/baselines/colored_groups.h"
#include "solver/baselines/iterative_baseline.h"

namespace cleave {
namespace {

class PgsColored : public SweepingBaseline {
 public:
  PgsColored(const SolveOptions& options, const Settings& settings)
      : SweepingBaseline("pgs-colored", options, settings),
        by_chance_(settings.text("coloring") == "vivace"),
        seed_(settings.integer("coloring-seed")) {}

 private:
  void begin(const PreparedStep& step) override {
    if (by_chance_) {
      groups_.color_by_chance(step.body_count(), step.groups(), seed_);
    } else {
      groups_.color(step.body_count(), step.groups());
    }
  }
  void sweep(const PreparedStep& step, Solution& solution) override {
    groups_.sweep(step, tasks(), solution);
  }

  bool by_chance_;
  int seed_;
  ColoredGroups groups_;
};

}  // namespace

std::unique_ptr<StepSolver> make_pgs_colored(const SolveOptions& options, const Settings& settings) {
  return std::make_unique<PgsColored>(options, settings);
}

}  // namespace cleave
