// Solvers `bullet-dantzig`, `bullet-lemke` and `bullet-pgs`: the mixed complementarity solvers of Bullet 3
// behind its btMLCPSolverInterface, in double precision (libBulletDynamics-float64). They take the dense
// problem (dense_problem.h).
//
// - Dantzig's method is ODE's, after Baraff, "Fast contact force computation for nonpenetrating rigid
//   bodies", SIGGRAPH 1994. Bullet asks whether the start, not the answer, is below 1000, so it starts from
//   zero.
// - Lemke's method after Lloyd, "Fast implementation of Lemke's algorithm for rigid body contact simulation",
//   ICRA 2005: Bullet inverts A by Gauss-Jordan elimination without pivoting and pivots in a tableau of twice
//   as many rows. It cannot take infinite bounds: 1e5 N s stands for them, beyond which Bullet calls an
//   impulse a failure. It reports success on answers that are none.
// - Projected Gauss-Seidel over the nonzeros of A, from the warm start, a fixed number of sweeps.
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btLemkeSolver.h>
#include <BulletDynamics/MLCPSolvers/btSolveProjectedGaussSeidel.h>

#include <algorithm>

#include "harness/base/stopwatch.h"
#include "harness/peers/dense_problem.h"
#include "harness/peers/peer.h"
#include "solver/parameters.h"

namespace cleave {
namespace {

constexpr double kNoBound = 1e5;   // m_maxValue of btLemkeSolver, N s
constexpr int kNoDependency = -1;  // bounds are frozen: none depends on the impulse of another row

btVectorXu vector_of(std::span<const double> values) {
  btVectorXu vector(static_cast<int>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) vector[static_cast<int>(i)] = values[i];
  return vector;
}

struct BulletProblem {
  explicit BulletProblem(const StepProblem& problem)
      : lower(vector_of(problem.lower)), upper(vector_of(problem.upper)) {
    const DenseProblem dense = make_dense_problem(problem);
    matrix.resize(dense.rows, dense.rows);
    for (int r = 0; r < dense.rows; ++r)
      for (int c = 0; c < dense.rows; ++c)
        matrix.setElem(r, c, dense.matrix[static_cast<std::size_t>(dense.rows) * r + c]);
    right_side = vector_of(dense.right_side);
    dependency.resize(dense.rows, kNoDependency);
  }

  void bound_everything() {
    for (int r = 0; r < lower.size(); ++r) {
      lower[r] = std::max(lower[r], -kNoBound);
      upper[r] = std::min(upper[r], kNoBound);
    }
  }

  btMatrixXu matrix;
  btVectorXu right_side, lower, upper;
  btAlignedObjectArray<int> dependency;
};

PeerAnswer solve(btMLCPSolverInterface& solver, BulletProblem& problem, btVectorXu impulse, int sweeps) {
  PeerAnswer answer;
  Stopwatch watch;
  answer.claims_success = solver.solveMLCP(problem.matrix, problem.right_side, impulse, problem.lower,
                                           problem.upper, problem.dependency, sweeps);
  answer.solve_ms = watch.lap_ms();
  if (!answer.claims_success) answer.message = "Bullet's solveMLCP returned false";
  answer.impulse.resize(impulse.size());
  for (int r = 0; r < impulse.size(); ++r) answer.impulse[r] = impulse[r];
  return answer;
}

btVectorXu zeros(int rows) { return vector_of(std::vector<double>(rows, 0.0)); }

}  // namespace

PeerAnswer solve_bullet_dantzig(const StepProblem& problem, std::span<const double>, const Settings&) {
  btDantzigSolver solver;
  BulletProblem bullet(problem);
  return solve(solver, bullet, zeros(problem.row_count()), 0);
}

PeerAnswer solve_bullet_lemke(const StepProblem& problem, std::span<const double>, const Settings& settings) {
  btLemkeSolver solver;
  solver.m_maxLoops = settings.integer(parameters::peer_iterations().name);
  BulletProblem bullet(problem);
  bullet.bound_everything();
  return solve(solver, bullet, zeros(problem.row_count()), 0);
}

PeerAnswer solve_bullet_pgs(const StepProblem& problem, std::span<const double> start,
                            const Settings& settings) {
  btSolveProjectedGaussSeidel solver;
  BulletProblem bullet(problem);
  const int sweeps = settings.integer(parameters::sweeps().name);
  PeerAnswer answer = solve(solver, bullet, vector_of(start), sweeps);
  answer.iterations = sweeps;
  return answer;
}

}  // namespace cleave
