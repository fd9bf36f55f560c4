#include "solver/factor_tasks.h"

#include <algorithm>
#include <atomic>

namespace cleave {
namespace {

// What takes a core about 20 microseconds. With four times as many, 10 000 rocks have critical paths half as
// long again.
constexpr double kLeastTiledFlops = 1e6;

bool is_tiled(const BlockSymbolic& symbolic, const Branch& branch) {
  return branch.first == branch.last && symbolic.supernodes()[branch.last].flops() >= kLeastTiledFlops;
}

// Tasks that work on a front while its next diagonal block is factored look at its flag.
std::atomic_ref<char> flag(std::vector<char>& factored, int branch) {
  return std::atomic_ref(factored[branch]);
}

bool are_factored(const BlockSymbolic& symbolic, int branch, std::vector<char>& factored) {
  return std::ranges::all_of(symbolic.child_branches(branch),
                             [&](int child) { return flag(factored, child) != 0; });
}

}  // namespace

int FactorTasks::add(const FactorTask& task, double place) {
  tasks_.push_back(task);
  places_.push_back(place);
  return task_count() - 1;
}

void FactorTasks::wait_for_children(const BlockSymbolic& symbolic, int branch, int task) {
  for (const int child : symbolic.child_branches(branch))
    if (last_task_[child] >= 0) waits_.emplace_back(last_task_[child], task);
}

void FactorTasks::list(const BlockSymbolic& symbolic, std::span<const int> branches) {
  tasks_.clear();
  waits_.clear();
  places_.clear();
  last_task_.assign(symbolic.branches().size(), -1);
  for (const int b : branches) {
    const Branch& branch = symbolic.branches()[b];
    const int assembly = add({Work::assembly, b, {}}, branch.place);
    if (is_tiled(symbolic, branch)) {
      list_front(symbolic, b, assembly);
    } else {
      last_task_[b] = add({Work::branch, b, {}}, branch.place);
      waits_.emplace_back(assembly, last_task_[b]);
      wait_for_children(symbolic, b, last_task_[b]);
    }
  }
  graph_.build(task_count(), waits_, places_);
}

// The first operation on a tile of the panel is that of step 0, and waits for the tile's columns. The last
// ones are the solves of the panel's last column, which wait for all others.
void FactorTasks::list_front(const BlockSymbolic& symbolic, int branch, int assembly) {
  const FrontStrips strips(symbolic.supernodes()[symbolic.branches()[branch].last]);
  const TileSchedule schedule(strips.count(), strips.own(), strips.joined_steps());
  const int first_gather = task_count(), first_tile = first_gather + strips.own();
  for (int strip = 0; strip < strips.own(); ++strip) {
    const double place = static_cast<double>(strip) / strips.own();
    const int gather = add({Work::gather, branch, {0, 0, strip}}, place);
    waits_.emplace_back(assembly, gather);
    wait_for_children(symbolic, branch, gather);
  }
  for (const TileOperation& operation : schedule.operations()) {
    const int task = add({Work::panel_tile, branch, operation}, schedule.place(task_count() - first_tile));
    if (operation.step == 0) waits_.emplace_back(first_gather + operation.column, task);
  }
  for (const auto& [earlier, later] : schedule.waits())
    waits_.emplace_back(first_tile + earlier, first_tile + later);
  const int first_update = task_count();
  for (int column = strips.own(); column < strips.count(); ++column) {
    for (int row = column; row < strips.count(); ++row) {
      const int last_of_row = schedule.last_on(row, strips.own() - 1);
      const int task = add({Work::update_tile, branch, {0, row, column}}, schedule.place(last_of_row));
      waits_.emplace_back(first_tile + last_of_row, task);
      if (row != column) waits_.emplace_back(first_tile + schedule.last_on(column, strips.own() - 1), task);
    }
  }
  last_task_[branch] = add({Work::nothing, branch, {}}, 0);
  for (int task = first_update; task < last_task_[branch]; ++task)
    waits_.emplace_back(task, last_task_[branch]);
}

void FactorTasks::run_task(const FactorTask& task, const WeightedRows& rows, BlockMatrix& matrix,
                           std::vector<char>& factored) {
  BlockCholesky& cholesky = matrix.cholesky();
  const BlockSymbolic& symbolic = cholesky.symbolic();
  const int supernode = symbolic.branches()[task.branch].last;
  switch (task.work) {
    case Work::assembly:
      matrix.assemble(rows, task.branch);
      break;
    case Work::branch:
      if (!are_factored(symbolic, task.branch, factored) || !matrix.factor(task.branch))
        flag(factored, task.branch) = 0;
      break;
    case Work::gather:
      matrix.gather(task.branch, task.tile.column);
      if (!are_factored(symbolic, task.branch, factored)) flag(factored, task.branch) = 0;
      break;
    case Work::panel_tile:
      if (flag(factored, task.branch) != 0 && !cholesky.front(supernode).run(task.tile))
        flag(factored, task.branch) = 0;
      break;
    case Work::update_tile:
      if (flag(factored, task.branch) != 0) cholesky.make_update(supernode, task.tile.row, task.tile.column);
      break;
    case Work::nothing:
      break;
  }
}

void FactorTasks::run(Stage stage, const WeightedRows& rows, BlockMatrix& matrix,
                      std::span<const char> changed, std::vector<char>& factored,
                      ParallelTasks& tasks) const {
  const auto run_changed = [&](int index) {
    if (changed[tasks_[index].branch]) run_task(tasks_[index], rows, matrix, factored);
  };
  const auto assembles = [&](int index) { return tasks_[index].work == Work::assembly; };
  tasks.run(stage, graph_, run_changed, Stage::assemble, assembles);
}

void FactorTasks::count(MemoryCount& memory) const {
  graph_.count(memory);
  memory.add_grown(tasks_, last_task_, waits_, places_);
}

}  // namespace cleave
