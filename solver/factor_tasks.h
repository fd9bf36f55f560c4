// Assembly and factorisation of a block matrix as tasks with what each waits for.
//
// The assembly of a branch is a task that waits for none, so that it fills the time in which few branches can
// be factored. A branch of the elimination tree with little work is one task more. A branch that is one large
// front is many (front_tiles.h): the columns of its panel gather what its children left, the operations on
// the panel's tiles follow, then the tiles of its update matrix, and one task without work tells the parent
// that all of them are there. Which branches are split, and how, depends on the pattern alone, and every tile
// sees the same operations in the same order, so threads do not change the factor.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/block_matrix.h"
#include "solver/parallel_tasks.h"
#include "solver/task_graph.h"

namespace cleave {

class FactorTasks {
 public:
  // Of these branches, ascending; what others they wait for is done, assembly included.
  void list(const BlockSymbolic& symbolic, std::span<const int> branches);
  // By branch, of all: changed, 1 where it is to be made anew from the rows, others stand as they are;
  // factored, 1 where a branch is. Those that meet a pivot that is not positive, and all above them, get 0.
  // Assembly counts as Stage::assemble.
  void run(Stage stage, const WeightedRows& rows, BlockMatrix& matrix, std::span<const char> changed,
           std::vector<char>& factored, ParallelTasks& tasks) const;
  int task_count() const { return static_cast<int>(tasks_.size()); }
  void count(MemoryCount& memory) const;

 private:
  enum class Work { assembly, branch, gather, panel_tile, update_tile, nothing };
  struct FactorTask {
    Work work;
    int branch;
    TileOperation tile;  // strips; a gather has a column alone, a tile of the update matrix no step
  };

  int add(const FactorTask& task, double place);
  void wait_for_children(const BlockSymbolic& symbolic, int branch, int task);
  void list_front(const BlockSymbolic& symbolic, int branch, int assembly);
  static void run_task(const FactorTask& task, const WeightedRows& rows, BlockMatrix& matrix,
                       std::vector<char>& factored);

  std::vector<FactorTask> tasks_;
  TaskGraph graph_;
  std::vector<int> last_task_;              // scratch: by branch; -1 where it is not listed
  std::vector<std::pair<int, int>> waits_;  // scratch
  std::vector<double> places_;              // scratch
};

}  // namespace cleave
