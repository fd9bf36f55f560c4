#include "tests/solver/task_shapes.h"

#include <numeric>
#include <vector>

#include "solver/block_matrix.h"
#include "solver/factor_tasks.h"
#include "solver/prepared_step.h"
#include "solver/separators.h"
#include "solver/slabs.h"

namespace cleave {

int count_slabs(const StepProblem& problem) {
  PreparedStep step;
  step.prepare(problem);
  Slabs slabs;
  slabs.cut(step, 1);
  return slabs.count();
}

// A branch that is not in tiles is two tasks, its assembly and its factorisation.
bool has_tiled_front(const StepProblem& problem, const Parts& parts) {
  PreparedStep step;
  step.prepare(problem);
  Separators separators;
  separators.find(step, parts);
  BlockMatrix matrix;
  matrix.analyze_whole(step, separators.node_of_body(), separators.node_count(), BlockSymbolic::kAnyBlocks);
  std::vector<int> branches(matrix.branch_count());
  std::iota(branches.begin(), branches.end(), 0);
  FactorTasks tasks;
  tasks.list(matrix.cholesky().symbolic(), branches);
  return tasks.task_count() > 2 * matrix.branch_count();
}

}  // namespace cleave
