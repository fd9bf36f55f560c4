// Gauss-Seidel in domains side by side, on copies of the bodies between them: mass splitting. The iteration
// of `jacobi-split`, whose domains are pairs of bodies, and `split-domains`, whose domains are parts.
//
// Every group of rows belongs to one domain. A body whose groups lie in k_i domains has a copy in each, of
// mass M_i / k_i. One sweep copies the velocities, goes once over the rows of every domain in their natural
// order,
//
//     d_r = sum over the bodies i of row r of k_i J_ri M_i^-1 J_ri^T, + C_r
//     w_r = J_r u + C_r lambda_r - b_r,   lambda_r <- clamp(lambda_r - w_r / d_r, lo_r, hi_r),
//     u_i += k_i M_i^-1 J_ri^T dlambda                                       u: copies of this domain
//
// and then gives every body the average of its copies, v_i = (1 / k_i) sum u_i. That is v = v0 + M^-1 J^T
// lambda again: each copy moved by k_i times what its domain's impulses move the body by.
//
// Why it converges: f(lambda) = 1/2 lambda^T (J M^-1 J^T + C) lambda + lambda^T (J v0 - b) is what the step
// problem minimises within its bounds, and by Cauchy and Schwarz the matrix of the split bodies, which is
// block diagonal over the domains, is no less than J M^-1 J^T + C. So a sweep lowers a bound of f that
// touches it where the sweep starts, and f never rises. More copies, slower convergence. With one domain it
// is projected Gauss-Seidel, to the same bytes.
//
// Source: Tonge, Benevolenski and Voroshilov, Mass splitting for jitter-free parallel rigid body simulation,
// ACM Transactions on Graphics 31(4), 2012.
#pragma once

#include <span>
#include <vector>

#include "solver/parallel_tasks.h"
#include "solver/prepared_step.h"

namespace cleave {

class SplitSweep {
 public:
  // Of a problem without turned boxes, which must stay as it is for run(). domain_of_group: one of 0 ..
  // domains - 1 for every group of the step. Buffers are kept from one problem to the next.
  void bind(const PreparedStep& step, std::span<const int> domain_of_group, int domains);

  // impulse (m) and v = v0 + M^-1 J^T impulse (n, 6) are updated in place, to the same bytes for any number
  // of threads.
  void run(std::span<double> impulse, std::span<double> v, ParallelTasks& tasks);

  int copies_of(int body) const { return first_of_body_[body + 1] - first_of_body_[body]; }

 private:
  void list_copies();
  int copy_of(int body, int domain);
  void split_diagonal();
  void cut_tasks();
  void sweep_domain(int domain, std::span<double> impulse, std::span<const double> v);
  void sweep_group(int group, std::span<double> impulse);
  void average(const Chunk& bodies, std::span<double> v) const;

  const PreparedStep* step_ = nullptr;
  std::vector<int> first_of_domain_, groups_;  // groups by domain, ascending
  std::vector<int> first_copy_;                // of each domain, in body_of_copy_
  std::vector<int> body_of_copy_;              // by domain
  std::vector<int> copy_a_, copy_b_;           // of each group; -1 for static
  std::vector<int> first_of_body_, copies_;    // copies by body, ascending
  std::vector<int> latest_copy_;               // scratch: of each body, -1 before its first
  std::vector<double> inverse_diagonal_;       // (m) 1 / d_r
  std::vector<double> u_;                      // (copies, 6)
  std::vector<Chunk> domain_chunks_;           // domains that one task sweeps
};

}  // namespace cleave
