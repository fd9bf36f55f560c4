// Solver `pgs-parts`: projected Gauss-Seidel (gauss_seidel.h) over the parts of the partition. A sweep is
//
//     the rows inside of parts: parts side by side, in natural order within each;
//     the rows of the cut, between two parts: colour after colour, those of one colour side by side
//     (colored_groups.h)
//
// Parts share no dynamic body, so the bytes do not depend on threads. With one part it is `pgs` in natural
// order. How fast it converges depends on the order alone that the partition makes, so that it measures
// partitions for iterative solvers.
#include <algorithm>

#include "solver/baselines/baselines.h"
#include "solver/baselines/colored_groups.h"
#include "solver/baselines/iterative_baseline.h"
#include "solver/counting_sort.h"
#include "solver/parts.h"

namespace cleave {
namespace {

class PgsParts : public SweepingBaseline {
 public:
  PgsParts(const SolveOptions& options, const Settings& settings)
      : SweepingBaseline("pgs-parts", options, settings) {}
  bool uses_partition() const override { return true; }

 private:
  // -1 of a group of the cut.
  int part_of(const RowGroup& g) const {
    const int part = part_of_body()[g.body_a];
    return g.body_b < 0 || part_of_body()[g.body_b] == part ? part : -1;
  }

  void begin(const PreparedStep& step) override {
    const std::span<const RowGroup> groups = step.groups();
    part_count_ = count_parts(part_of_body());
    sort_into_buckets(
        static_cast<int>(groups.size()), part_count_, [&](int g) { return part_of(groups[g]); },
        first_inside_, inside_);
    cut_.clear();
    for (const RowGroup& g : groups)
      if (part_of(g) < 0) cut_.push_back(g);
    cut_groups_.color(step.body_count(), cut_);
  }

  void sweep(const PreparedStep& step, Solution& solution) override {
    tasks().run(part_count_, [&](int part) {
      for (int i = first_inside_[part]; i < first_inside_[part + 1]; ++i)
        gauss_seidel_visit(step, step.groups()[inside_[i]], LaneSlack{}, WithinBounds(step), solution.impulse,
                           solution.velocity);
    });
    cut_groups_.sweep(step, tasks(), solution);
  }

  int part_count_ = 0;
  std::vector<int> first_inside_, inside_;  // groups inside of each part
  std::vector<RowGroup> cut_;
  ColoredGroups cut_groups_;
};

}  // namespace

std::unique_ptr<StepSolver> make_pgs_parts(const SolveOptions& options, const Settings& settings) {
  return std::make_unique<PgsParts>(options, settings);
}

}  // namespace cleave
