// A kernel solves the one linear system that every strategy needs, for changing weights D on a fixed pattern:
//
//     M dv - J^T dlambda       = f_v        (n, 6)
//     J dv + D^-1 dlambda      = f_r        on rows with D > 0;  dlambda = 0 on rows with D = 0
//
// which is (M + J^T D J) dv = f_v + J^T D f_r with dlambda = D (f_r - J dv). D is diagonal or, per contact, a
// symmetric 3x3 block in a basis, on whose rows J, f_r and dlambda are those along the basis (row_weights.h).
// Adding a kernel: one new file in this folder, its make_...() declared below, and one row in registry.cpp.
#pragma once

#include <memory>
#include <span>

#include "harness/base/parameter.h"
#include "solver/parallel_tasks.h"
#include "solver/parts.h"
#include "solver/prepared_step.h"
#include "solver/row_weights.h"

namespace cleave {

class Kernel {
 public:
  virtual ~Kernel() = default;

  // Symbolic analysis of the pattern; step and parts must outlive the kernel's use. parts: unused by
  // kernels that do not split. What factor and workspace will take, with D > 0 on every row, is requested of
  // tasks.memory() before it is allocated: throws MemoryRefused, here and in rebind.
  virtual void analyze(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) = 0;
  // Whether analyze and rebind run no tasks, so that they may be one, in the background of a solve.
  virtual bool analyzes_as_a_task() const { return false; }

  // Instead of analyze, for the bodies and parts analysed last but other rows: true where every pair of
  // bodies that shares a row has its place in the analysed pattern, whose order is then kept. False: analyze.
  virtual bool rebind(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) = 0;

  // Numeric factorisation for D, diagonal or with blocks; before: writes the weights of a chunk's rows,
  // before they are read. False when the matrix is not positive definite to working precision.
  virtual bool factor(const RowWeights& weights, ParallelTasks& tasks, const RowWork& before = {}) = 0;

  // Solves with the last factor; f_v (n, 6), f_r (m), dv (n, 6), dlambda (m).
  // On the rows of a block f_r and dlambda are along its basis. around: before f_r is read, and after dlambda
  // is written.
  virtual void solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
                     std::span<double> dlambda, ParallelTasks& tasks, const RowsAround& around = {}) = 0;

  virtual int interface_unknowns() const { return 0; }
  // Arithmetic of a factorisation, without padding, in Mflop.
  virtual double local_mflop() const = 0;
  virtual double interface_mflop() const { return 0; }
  // Of the last one, which may have kept what had not changed.
  virtual double done_mflop() const { return local_mflop() + interface_mflop(); }

  // Whether its factor is one of H alone, without rows, so that it can serve a later step (carried_factor.h).
  // Only then is there:
  virtual bool can_be_carried() const { return false; }
  // x (n, 6) = H^-1 f with the H of the last factorisation, of whatever step that was with these bodies.
  virtual void apply_factor(std::span<const double>, std::span<double>, ParallelTasks&) {}
  virtual double apply_mflop() const { return 0; }  // arithmetic of apply_factor

 protected:
  // Where a kernel has no pass over the rows that the work could be part of.
  static void run_work(const RowWork& work, const PreparedStep& step, ParallelTasks& tasks) {
    if (work) tasks.run_over(step.group_chunks(), [&](const Chunk& chunk) { step.do_rows(work, chunk); });
  }
};

std::unique_ptr<Kernel> make_dense_kernel(const Settings& settings);
std::unique_ptr<Kernel> make_monolithic_kernel(const Settings& settings);
std::unique_ptr<Kernel> make_schur_rows_kernel(const Settings& settings);
std::unique_ptr<Kernel> make_schur_bodies_kernel(const Settings& settings);
std::unique_ptr<Kernel> make_schur_nested_kernel(const Settings& settings);

}  // namespace cleave
