#include "solver/kernels/branch_kernel.h"

#include <algorithm>

#include "solver/group_products.h"

namespace cleave {

void BranchKernel::bind(const PreparedStep& step) {
  step_ = &step;
  group_sums_.resize(12 * step.groups().size());
  x_.resize(6 * static_cast<std::size_t>(step.body_count()));
}

void BranchKernel::choose_separators(const PreparedStep& step, const Parts& parts, Stages& stages) {
  separators_.find(step, parts);
  stages.of_body.assign(separators_.node_of_body().begin(), separators_.node_of_body().end());
  stages.count = separators_.node_count();
  stages.first_of_interface = separators_.part_count();
}

void BranchKernel::analyze(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) {
  StageTimer timer(tasks.clock(), Stage::analyze);
  bind(step);
  choose_stages(step, parts, stages_);
  interface_bodies_ = static_cast<int>(
      std::ranges::count_if(stages_.of_body, [this](int s) { return s >= stages_.first_of_interface; }));
  const bool analyzed = matrix_.analyze_whole(step, stages_.of_body, stages_.count,
                                              BlockMatrix::most_blocks(tasks.memory().limit_bytes()));
  if (analyzed) list_tasks();
  request_memory(tasks, analyzed);
  matrix_.allocate();
}

void BranchKernel::request_memory(ParallelTasks& tasks, bool analyzed) {
  const PreparedStep& step = *step_;
  MemoryCount memory;
  matrix_.count(memory);
  separators_.count(memory);
  for (const TaskGraph* graph :
       {&assembly_graph_, &local_graph_, &interface_graph_, &forward_graph_, &backward_graph_})
    graph->count(memory);
  memory.add_grown(stages_.of_body, local_branches_, interface_branches_, waits_, task_of_branch_, places_,
                   factored_);
  memory.add<double>(12, step.groups().size());
  memory.add<double>(6, step.body_count());
  if (!step.set().axes().empty()) memory.add<double>(12, step.row_count());
  tasks.memory().request(memory, analyzed);
}

bool BranchKernel::rebind(const PreparedStep& step, const Parts&, ParallelTasks& tasks) {
  StageTimer timer(tasks.clock(), Stage::analyze);
  bind(step);
  if (!matrix_.rebind_whole(step)) return false;
  request_memory(tasks, true);
  matrix_.allocate();
  return true;
}

// Branches of the interface come after the others, as stages of columns of their own.
void BranchKernel::list_tasks() {
  const auto branches = matrix_.cholesky().symbolic().branches();
  const int count = static_cast<int>(branches.size());
  factored_.resize(count);
  local_branches_.clear();
  interface_branches_.clear();
  task_of_branch_.resize(count);
  const auto is_local = [&](int b) { return branches[b].stage < stages_.first_of_interface; };
  for (int b = 0; b < count; ++b) {
    std::vector<int>& list = is_local(b) ? local_branches_ : interface_branches_;
    task_of_branch_[b] = static_cast<int>(list.size());
    list.push_back(b);
  }
  const auto build = [&](TaskGraph& graph, const std::vector<int>& list) {
    waits_.clear();
    places_.clear();
    for (const int b : list) {
      places_.push_back(branches[b].place);
      const int parent = branches[b].parent;
      if (parent >= 0 && is_local(parent) == is_local(b))
        waits_.emplace_back(task_of_branch_[b], task_of_branch_[parent]);
    }
    graph.build(static_cast<int>(list.size()), waits_, places_);
  };
  build(local_graph_, local_branches_);
  build(interface_graph_, interface_branches_);
  waits_.clear();
  places_.clear();
  for (int b = 0; b < count; ++b) {
    places_.push_back(branches[b].place);
    if (branches[b].parent >= 0) waits_.emplace_back(b, branches[b].parent);
  }
  assembly_graph_.build(count, {}, places_);
  forward_graph_.build(count, waits_, places_);
  for (auto& [earlier, later] : waits_) {
    const int child = earlier;
    earlier = count - 1 - later, later = count - 1 - child;
  }
  std::ranges::reverse(places_);
  backward_graph_.build(count, waits_, places_);
}

bool BranchKernel::factor(const RowWeights& weights, ParallelTasks& tasks) {
  {
    StageTimer timer(tasks.clock(), Stage::assemble);
    rows_.set(step_->problem(), weights);
  }
  tasks.run(Stage::assemble, assembly_graph_, [&](int b) { matrix_.assemble(rows_, b); });
  std::ranges::fill(factored_, 1);
  const auto factor_branch = [&](int b) {
    for (const int child : matrix_.cholesky().symbolic().child_branches(b)) {
      if (!factored_[child]) factored_[b] = 0;
    }
    if (factored_[b]) factored_[b] = matrix_.factor(b);
  };
  tasks.run(Stage::factor_local, local_graph_, [&](int t) { factor_branch(local_branches_[t]); });
  tasks.run(Stage::factor_interface, interface_graph_, [&](int t) { factor_branch(interface_branches_[t]); });
  return std::ranges::find(factored_, 0) == factored_.end();
}

void BranchKernel::reduce(const Chunk& chunk, std::span<const double> f_r) {
  const std::span<const double> d = rows_.d();
  for (int g = chunk.first; g < chunk.last; ++g) {
    double sum[12];
    sum_rows(
        step_->groups()[g], rows_.jacobian(), [&](int r) { return d[r] * f_r[r]; }, sum);
    std::copy_n(sum, 12, group_sums_.data() + 12L * g);
  }
}

void BranchKernel::gather(const Chunk& chunk, std::span<const double> f_v) {
  const auto position = matrix_.cholesky().symbolic().position_of_node();
  for (int body = chunk.first; body < chunk.last; ++body)
    add_sides(step_->sides_of_body(body), group_sums_.data(), f_v.data() + 6L * body,
              x_.data() + 6L * position[body]);
}

void BranchKernel::expand(const Chunk& chunk, std::span<const double> f_r, std::span<double> dlambda) const {
  const std::span<const double> d = rows_.d();
  const auto position = matrix_.cholesky().symbolic().position_of_node();
  for (int g = chunk.first; g < chunk.last; ++g) {
    const RowGroup& group = step_->groups()[g];
    double both[12];
    load_pair(x_.data() + 6L * position[group.body_a],
              group.body_b < 0 ? nullptr : x_.data() + 6L * position[group.body_b], both);
    for (int r = group.first_row; r < group.first_row + group.row_count; ++r)
      dlambda[r] = d[r] * (f_r[r] - row_times(rows_.jacobian() + 12L * r, both));
  }
}

void BranchKernel::solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
                         std::span<double> dlambda, ParallelTasks& tasks) {
  StageTimer timer(tasks.clock(), Stage::solve);
  BlockCholesky& cholesky = matrix_.cholesky();
  const auto groups = step_->group_chunks(), bodies = step_->body_chunks();
  const int group_tasks = static_cast<int>(groups.size()), body_tasks = static_cast<int>(bodies.size());
  const int last_branch = matrix_.branch_count() - 1;
  const auto position = cholesky.symbolic().position_of_node();
  tasks.run(group_tasks, [&](int i) { reduce(groups[i], f_r); });
  tasks.run(body_tasks, [&](int i) { gather(bodies[i], f_v); });
  tasks.run(Stage::solve, forward_graph_, [&](int b) { cholesky.forward(b, x_.data()); });
  tasks.run(Stage::solve, backward_graph_, [&](int t) { cholesky.backward(last_branch - t, x_.data()); });
  tasks.run(group_tasks + body_tasks, [&](int i) {
    if (i < group_tasks) return expand(groups[i], f_r, dlambda);
    const Chunk& chunk = bodies[i - group_tasks];
    for (int body = chunk.first; body < chunk.last; ++body)
      std::copy_n(x_.data() + 6L * position[body], 6, dv.data() + 6L * body);
  });
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

}  // namespace cleave
