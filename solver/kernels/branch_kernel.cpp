#include "solver/kernels/branch_kernel.h"

#include <algorithm>
#include <atomic>

#include "solver/lasting_bodies.h"

namespace cleave {

void BranchKernel::bind(const PreparedStep& step) {
  step_ = &step;
  kept_.bind(step);
  system_.bind(step, matrix_.cholesky().symbolic().position_of_node());
  x_.resize(6 * static_cast<std::size_t>(step.body_count()));
}

void BranchKernel::choose_separators(const PreparedStep& step, const Parts& parts, Stages& stages) {
  separators_.find(step, parts);
  stages.of_body.assign(separators_.node_of_body().begin(), separators_.node_of_body().end());
  stages.count = separators_.node_count();
  stages.first_of_interface = separators_.part_count();
}

// In every part; its stage becomes two.
void BranchKernel::put_lasting_bodies_first(const PreparedStep& step) {
  if (!find_lasting_bodies(step, lasting_)) return;
  const int parts = stages_.first_of_interface;
  stages_.of_body.resize(step.body_count(), 0);
  for (int body = 0; body < step.body_count(); ++body) {
    int& stage = stages_.of_body[body];
    stage = stage >= parts ? stage + parts : 2 * stage + (lasting_[body] == 0);
  }
  stages_.count += parts;
  stages_.first_of_interface += parts;
}

void BranchKernel::analyze(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) {
  StageTimer timer(tasks.clock(), Stage::analyze);
  stages_.of_body.clear();
  stages_.count = stages_.first_of_interface = 1;
  choose_stages(step, parts, stages_);
  put_lasting_bodies_first(step);
  interface_bodies_ = static_cast<int>(
      std::ranges::count_if(stages_.of_body, [this](int s) { return s >= stages_.first_of_interface; }));
  const bool analyzed = matrix_.analyze_whole(step, stages_.of_body, stages_.count,
                                              BlockMatrix::most_blocks(tasks.memory().limit_bytes()));
  if (analyzed) list_tasks(tasks.threads());
  request_memory(step, tasks, analyzed);
  matrix_.allocate();
  bind(step);
}

void BranchKernel::request_memory(const PreparedStep& step, ParallelTasks& tasks, bool analyzed) {
  MemoryCount memory;
  matrix_.count(memory);
  if (analyzed) memory.add<double>(1, step.row_count());
  separators_.count(memory);
  substitution_.count(memory);
  for (const FactorTasks* factor : {&local_tasks_, &interface_tasks_}) factor->count(memory);
  memory.add_grown(stages_.of_body, lasting_, changed_, factored_);
  memory.add<double>(12, step.groups().size());
  memory.add<double>(6, step.body_count());
  if (step.set().has_blocks()) memory.add<double>(12, step.row_count());
  tasks.memory().request(memory, analyzed);
}

bool BranchKernel::rebind(const PreparedStep& step, const Parts&, ParallelTasks& tasks) {
  StageTimer timer(tasks.clock(), Stage::analyze);
  if (!matrix_.rebind_whole(step)) return false;
  request_memory(step, tasks, true);
  matrix_.allocate();
  bind(step);
  return true;
}

// Branches of the interface come after the others, as stages of columns of their own.
void BranchKernel::list_tasks(int threads) {
  const BlockSymbolic& symbolic = matrix_.cholesky().symbolic();
  const auto branches = symbolic.branches();
  const int count = static_cast<int>(branches.size());
  changed_.resize(count);
  factored_.resize(count);
  std::vector<int> local, interface;
  for (int b = 0; b < count; ++b)
    (branches[b].stage < stages_.first_of_interface ? local : interface).push_back(b);
  local_tasks_.list(symbolic, local);
  interface_tasks_.list(symbolic, interface);
  substitution_.join(symbolic, threads);
}

// With the rows that the weights turn, in one pass.
void BranchKernel::find_changed(const RowWeights& weights, const RowWork& before, ParallelTasks& tasks) {
  std::ranges::fill(changed_, kept_.begin(weights));
  tasks.run_over(step_->group_chunks(), [&](const Chunk& groups) {
    step_->do_rows(before, groups);
    system_.turn(groups);
    for (int g = groups.first; g < groups.last; ++g)
      if (kept_.take(step_->groups()[g], weights.d))
        std::atomic_ref(changed_[matrix_.branch_of_group(g)]).store(1, std::memory_order_relaxed);
  });
  const auto branches = matrix_.cholesky().symbolic().branches();
  for (std::size_t b = 0; b < branches.size(); ++b)
    if (changed_[b] && branches[b].parent >= 0) changed_[branches[b].parent] = 1;
}

bool BranchKernel::factor(const RowWeights& weights, ParallelTasks& tasks, const RowWork& before) {
  {
    StageTimer timer(tasks.clock(), Stage::assemble);
    system_.set(weights);
    find_changed(weights, before, tasks);
  }
  std::ranges::fill(factored_, 1);
  const WeightedRows& rows = system_.rows();
  local_tasks_.run(Stage::factor_local, rows, matrix_, changed_, factored_, tasks);
  interface_tasks_.run(Stage::factor_interface, rows, matrix_, changed_, factored_, tasks);
  const bool succeeded = std::ranges::find(factored_, 0) == factored_.end();
  kept_.end(succeeded, weights);
  return succeeded;
}

// before(b) and after(b): of each branch, on its way up and on its way down.
template <class Before, class After>
void BranchKernel::substitute(ParallelTasks& tasks, const Before& before, const After& after) {
  BlockCholesky& cholesky = matrix_.cholesky();
  const int count = substitution_.group_count();
  tasks.run(Stage::solve, substitution_.graph(), [&](int task) {
    if (task < count) {
      for (const int branch : substitution_.branches(task)) {
        before(branch);
        cholesky.forward(branch, x_.data());
      }
    } else {
      const std::span<const int> upwards = substitution_.branches(2 * count - 1 - task);
      for (auto branch = upwards.rbegin(); branch != upwards.rend(); ++branch) {
        cholesky.backward(*branch, x_.data());
        after(*branch);
      }
    }
  });
}

// Rows go in chunks in the order in which they lie in memory: branch by branch, in the graph, the whole took
// a tenth longer.
void BranchKernel::solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
                         std::span<double> dlambda, ParallelTasks& tasks, const RowsAround& around) {
  StageTimer timer(tasks.clock(), Stage::solve);
  const auto groups = step_->group_chunks();
  tasks.run_over(groups, [&](const Chunk& chunk) {
    step_->do_rows(around.before, chunk);
    system_.weigh(chunk, f_r);
  });
  substitute(
      tasks, [&](int branch) { system_.collect(matrix_.bodies_of(branch), f_v, x_); },
      [&](int branch) { system_.to_bodies(matrix_.bodies_of(branch), x_, dv); });
  tasks.run_over(groups, [&](const Chunk& chunk) {
    system_.expand(chunk, x_, f_r, dlambda);
    step_->do_rows(around.after, chunk);
  });
}

void BranchKernel::apply_factor(std::span<const double> f, std::span<double> x, ParallelTasks& tasks) {
  substitute(
      tasks, [&](int branch) { system_.to_positions(matrix_.bodies_of(branch), f, x_); },
      [&](int branch) { system_.to_bodies(matrix_.bodies_of(branch), x_, x); });
}

double BranchKernel::local_mflop() const {
  double flops = 0;
  for (int s = 0; s < std::min(stages_.first_of_interface, stages_.count); ++s)
    flops += matrix_.cholesky().symbolic().factor_flops(s);
  return flops * 1e-6;
}

double BranchKernel::interface_mflop() const {
  double flops = 0;
  for (int s = stages_.first_of_interface; s < stages_.count; ++s)
    flops += matrix_.cholesky().symbolic().factor_flops(s);
  return flops * 1e-6;
}

double BranchKernel::done_mflop() const {
  const auto branches = matrix_.cholesky().symbolic().branches();
  double flops = 0;
  for (std::size_t b = 0; b < branches.size(); ++b) flops += changed_[b] ? branches[b].flops : 0;
  return flops * 1e-6;
}

// A multiplication and an addition for every entry of L, forth and back.
double BranchKernel::apply_mflop() const {
  return 4e-6 * static_cast<double>(matrix_.cholesky().symbolic().factor_size());
}

}  // namespace cleave
