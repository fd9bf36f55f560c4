// What `monolithic` and the kernels with an interface of bodies share: one sparse block Cholesky
// factorisation of H = M + J^T D J over all bodies,
//
//     H dv = f_v + J^T D f_r,     dlambda = D (f_r - J dv),
//
// dealt out in branches of its elimination tree (block_symbolic.h). A branch is assembled at any time and
// factored after its child branches, in tiles where it is large (factor_tasks.h). Substitution is one graph,
// forward from the leaves to the root and back again, whose tasks are branches joined until they are worth
// one (branch_groups.h); what is read off rows comes before and after it, in chunks that lie side by side in
// memory. A kernel only says in what order bodies are eliminated.
//
// Strategies that end near the solution change few weights from one factorisation to the next. Only branches
// with a changed row, and those above them, are made anew; the others stand as they are, and the factor has
// the bytes of a whole one. In each part bodies on which no row will change come first (lasting_bodies.h).
#pragma once

#include <span>
#include <vector>

#include "solver/block_matrix.h"
#include "solver/body_system.h"
#include "solver/branch_groups.h"
#include "solver/factor_tasks.h"
#include "solver/kept_weights.h"
#include "solver/kernels/kernel.h"
#include "solver/separators.h"

namespace cleave {

class BranchKernel : public Kernel {
 public:
  void analyze(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) override;
  bool analyzes_as_a_task() const override { return true; }
  bool rebind(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) override;
  bool factor(const RowWeights& weights, ParallelTasks& tasks, const RowWork& before) override;
  void solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
             std::span<double> dlambda, ParallelTasks& tasks, const RowsAround& around) override;
  int interface_unknowns() const override { return 6 * interface_bodies_; }
  double local_mflop() const override;
  double interface_mflop() const override;
  double done_mflop() const override;
  bool can_be_carried() const override { return true; }
  void apply_factor(std::span<const double> f, std::span<double> x, ParallelTasks& tasks) override;
  double apply_mflop() const override;

 protected:
  // Of every body, in the order of elimination; no body in the stages of the interface leaves one.
  struct Stages {
    std::vector<int> of_body;  // empty: one stage
    int count = 1;
    int first_of_interface = 1;
  };
  virtual void choose_stages(const PreparedStep& step, const Parts& parts, Stages& stages) = 0;
  // Parts first, then what stands between them, level by level.
  void choose_separators(const PreparedStep& step, const Parts& parts, Stages& stages);

 private:
  void put_lasting_bodies_first(const PreparedStep& step);
  void bind(const PreparedStep& step);
  void list_tasks(int threads);
  void find_changed(const RowWeights& weights, const RowWork& before, ParallelTasks& tasks);
  void request_memory(const PreparedStep& step, ParallelTasks& tasks, bool analyzed);
  template <class Before, class After>
  void substitute(ParallelTasks& tasks, const Before& before, const After& after);

  const PreparedStep* step_ = nullptr;
  Stages stages_;
  std::vector<char> lasting_;  // by body
  Separators separators_;
  BodySystem system_;
  BlockMatrix matrix_;
  int interface_bodies_ = 0;
  FactorTasks local_tasks_, interface_tasks_;
  BranchGroups substitution_;
  KeptWeights kept_;
  std::vector<char> changed_, factored_;  // by branch
  std::vector<double> x_;                 // (n, 6) by position
};

}  // namespace cleave
