#include "tests/benchmarks/cholmod_reference.h"

#include <algorithm>
#include <stdexcept>

namespace cleave {
namespace {

void add_entry(cholmod_triplet& triplet, int row, int column, double value) {
  if (row < column) return;  // lower triangle
  static_cast<int*>(triplet.i)[triplet.nnz] = row;
  static_cast<int*>(triplet.j)[triplet.nnz] = column;
  static_cast<double*>(triplet.x)[triplet.nnz++] = value;
}

// The 12 x 12 block D_r J_r^T J_r of one row; static sides have no place in H.
void add_row(const StepProblem& problem, int r, double d, cholmod_triplet& triplet) {
  const double* jacobian = problem.jacobian.data() + 12L * r;
  for (int k = 0; k < 12; ++k) {
    for (int l = 0; l < 12; ++l) {
      const int body_k = problem.row_body[2 * r + k / 6], body_l = problem.row_body[2 * r + l / 6];
      if (body_k < 0 || body_l < 0) continue;
      add_entry(triplet, 6 * body_k + k % 6, 6 * body_l + l % 6, d * jacobian[k] * jacobian[l]);
    }
  }
}

}  // namespace

CholmodReference::CholmodReference(const StepProblem& problem, std::span<const double> d, bool supernodal) {
  cholmod_start(&common_);
  const int n = problem.body_count(), m = problem.row_count();
  cholmod_triplet* triplet =
      cholmod_allocate_triplet(6 * n, 6 * n, 36L * n + 144L * m, -1, CHOLMOD_REAL, &common_);
  if (triplet == nullptr) throw std::runtime_error("CHOLMOD is out of memory");
  for (int body = 0; body < n; ++body) {
    for (int k = 0; k < 36; ++k) {
      add_entry(*triplet, 6 * body + k / 6, 6 * body + k % 6, problem.mass[36L * body + k]);
    }
  }
  for (int r = 0; r < m; ++r) add_row(problem, r, d[r], *triplet);
  matrix_ = cholmod_triplet_to_sparse(triplet, 0, &common_);
  cholmod_free_triplet(&triplet, &common_);
  common_.nmethods = 9;  // tries all of its orderings and keeps the one of the fewest operations
  common_.supernodal = supernodal ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
  factor_ = cholmod_analyze(matrix_, &common_);
  if (factor_ == nullptr) throw std::runtime_error("CHOLMOD cannot analyse this matrix");
  flops_ = common_.fl;
}

CholmodReference::~CholmodReference() {
  cholmod_free_factor(&factor_, &common_);
  cholmod_free_sparse(&matrix_, &common_);
  cholmod_finish(&common_);
}

void CholmodReference::factor() {
  if (!cholmod_factorize(matrix_, factor_, &common_) || common_.status != CHOLMOD_OK) {
    throw std::runtime_error("CHOLMOD cannot factor this matrix");
  }
}

std::vector<double> CholmodReference::solve(std::span<const double> f_v) {
  cholmod_dense* right = cholmod_allocate_dense(f_v.size(), 1, f_v.size(), CHOLMOD_REAL, &common_);
  std::ranges::copy(f_v, static_cast<double*>(right->x));
  cholmod_dense* left = cholmod_solve(CHOLMOD_A, factor_, right, &common_);
  const double* x = static_cast<double*>(left->x);
  std::vector<double> solution(x, x + f_v.size());
  cholmod_free_dense(&right, &common_);
  cholmod_free_dense(&left, &common_);
  return solution;
}

}  // namespace cleave
