#include "solver/kept_analysis.h"

#include <algorithm>
#include <utility>

namespace cleave {

bool KeptAnalysis::serves(Kernel& kernel, const PreparedStep& step, const Parts& given,
                          ParallelTasks& tasks) {
  if (step.body_count() != bodies_) return false;
  if (!std::ranges::equal(given.part_of_body, part_of_body_)) return false;
  if (!std::ranges::equal(given.parent_of_part, parent_of_part_)) return false;
  return step.problem().row_body == row_body_ || kernel.rebind(step, parts(), tasks);
}

void KeptAnalysis::analyze(Kernel& kernel, const PreparedStep& step, const Parts& given, bool may_keep,
                           ParallelTasks& tasks) {
  // Not made until all of it is done: there may be no memory half-way.
  const bool was_made = std::exchange(is_made_, false);
  const bool served = was_made && may_keep && serves(kernel, step, given, tasks);
  {
    StageTimer timer(tasks.clock(), Stage::analyze);
    bodies_ = step.body_count();
    row_body_ = step.problem().row_body;
    part_of_body_.assign(given.part_of_body.begin(), given.part_of_body.end());
    parent_of_part_.assign(given.parent_of_part.begin(), given.parent_of_part.end());
  }
  if (!served) kernel.analyze(step, parts(), tasks);
  is_made_ = true;
}

}  // namespace cleave
