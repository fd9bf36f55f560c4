// Solvers `dart-dantzig` and `dart-pgs`: the boxed complementarity solvers of DART 6, called as its
// BoxedLcpConstraintSolver calls them: rows padded to a multiple of four numbers (dPAD of ODE, from where
// both come).
//
// - Dantzig's method after Baraff, SIGGRAPH 1994, from zero. DART falls back on projected Gauss-Seidel where
//   it fails; here failure is failure.
// - Projected Gauss-Seidel, `sweeps` iterations, from the warm start. Its tolerances are zero, so that it
//   does all of them; with DART's 1e-3 it would leave off early.
//
// Compiled for any x86-64 and with Eigen under its own name (CMakeLists.txt), as DART was: its classes hold
// matrices of Eigen.
#include <dart/constraint/DantzigBoxedLcpSolver.hpp>
#include <dart/constraint/PgsBoxedLcpSolver.hpp>

#include "harness/base/stopwatch.h"
#include "harness/peers/dense_problem.h"
#include "harness/peers/peer.h"
#include "solver/parameters.h"

namespace cleave {
namespace {

constexpr int kNoDependency = -1;

// Rows of n numbers, each begun at a multiple of four.
std::size_t padded(int n) { return n > 1 ? ((static_cast<std::size_t>(n) - 1) | 3) + 1 : n; }

std::vector<double> padded_matrix(const DenseProblem& dense) {
  const std::size_t width = padded(dense.rows), m = dense.rows;
  std::vector<double> matrix(width * m, 0.0);
  for (std::size_t r = 0; r < m; ++r)
    std::copy_n(&dense.matrix[m * r], m, matrix.begin() + static_cast<std::ptrdiff_t>(width * r));
  return matrix;
}

PeerAnswer solve(dart::constraint::BoxedLcpSolver& solver, const StepProblem& problem,
                 std::vector<double> impulse) {
  DenseProblem dense = make_dense_problem(problem);
  std::vector<double> matrix = padded_matrix(dense), lower = problem.lower, upper = problem.upper;
  std::vector<int> dependency(dense.rows, kNoDependency);
  PeerAnswer answer;
  Stopwatch watch;
  answer.claims_success = solver.solve(dense.rows, matrix.data(), impulse.data(), dense.right_side.data(), 0,
                                       lower.data(), upper.data(), dependency.data(), true);
  answer.solve_ms = watch.lap_ms();
  if (!answer.claims_success) answer.message = "DART's solve returned false";
  answer.impulse = std::move(impulse);
  return answer;
}

}  // namespace

PeerAnswer solve_dart_dantzig(const StepProblem& problem, std::span<const double>, const Settings&) {
  dart::constraint::DantzigBoxedLcpSolver solver;
  return solve(solver, problem, std::vector<double>(problem.row_count(), 0.0));
}

PeerAnswer solve_dart_pgs(const StepProblem& problem, std::span<const double> start,
                          const Settings& settings) {
  const int sweeps = settings.integer(parameters::sweeps().name);
  dart::constraint::PgsBoxedLcpSolver solver;
  solver.setOption({sweeps, 0.0, 0.0, 1e-300, false});
  PeerAnswer answer = solve(solver, problem, {start.begin(), start.end()});
  answer.iterations = sweeps;
  // It returns whether a tolerance was met, and there is none.
  answer.claims_success = true;
  answer.message.clear();
  return answer;
}

}  // namespace cleave
