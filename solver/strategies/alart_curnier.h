// The last attempt under Coulomb's law: a semi-smooth Newton method on the law itself, without de Saxce's
// shift, and without the symmetry that the kernels' factor needs.
//
// Of a contact with impulse (n, t), slack (w_n, w_t) and rho the inverse of its diagonal, the law is F = 0
// with
//
//     F_n = n - max(0, n - rho w_n),    F_t = t - P_D(t - rho w_t),   D = { |t| <= mu max(0, n - rho w_n) },
//
// of any other row F = lambda - clamp(lambda - rho w). With P' the derivative of what is projected, a
// contact's block of it unsymmetric where it slides, a step solves
//
//     (I - P' + P' rho C) dlambda + P' rho J dv = -F,    M dv = J^T dlambda.
//
// Eliminating dlambda leaves (M + J^T E J) dv = -J^T g with E = G^-1 P' rho, g = G^-1 F, G = I - P' + P' rho
// C, a sparse matrix of body blocks for LU. Steps are halved until the energy sum F^2 / rho falls below the
// greatest of the last few, so that it may rise in between.
//
// A factorisation takes several times as long as a kernel's, and a hundred may be needed, so it comes after
// all else. Sources: Alart and Curnier, "A mixed formulation for frictional contact problems prone to Newton
// like solution methods", Comput. Methods Appl. Mech. Eng. 92, 1991; Grippo, Lampariello and Lucidi, "A
// nonmonotone line search technique for Newton's method", SIAM J. Numer. Anal. 23, 1986.
#pragma once

#include <Eigen/LU>
#include <Eigen/SparseLU>
#include <deque>
#include <span>
#include <vector>

#include "solver/solve_state.h"

namespace cleave {

class AlartCurnier {
 public:
  // From zero impulses and then from those of the step before, a few steps from each and then all of them,
  // until the residual is within the limit. The impulses of the least residual stay, the present ones
  // included. False where none is within it, or where the problem is none for it: more rows than LU is worth
  // its time for, turned boxes, or cones without the law. What LU needs is not in the predicted memory.
  bool run(SolveState& state, std::span<const double> warm_impulse);

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  // The rows of a contact, or another row by itself. Vectors of a block have three entries, zero beyond its
  // rows.
  struct Block {
    Eigen::Vector3d load(std::span<const double> x) const;
    void store(const Eigen::Vector3d& value, std::span<double> x) const;
    Eigen::Vector3d aim(const SolveState& state) const;  // lambda - rho w
    Eigen::Vector3d project(const StepProblem& problem, const Eigen::Vector3d& y) const;
    Eigen::Matrix3d differentiate(const StepProblem& problem, const Eigen::Vector3d& y) const;
    void linearize(const SolveState& state);

    int first_row, row_count;
    const FrictionCone* cone;  // nullptr: no contact
    Eigen::Vector3d rho;
    Eigen::Matrix3d derivative, g_inverse, e;  // P', G^-1, E
  };

  bool attempt(SolveState& state, std::span<const double> start, long most);
  void load(SolveState& state, std::span<const double> impulse) const;
  void list_blocks(const SolveState& state);
  double find_error(const SolveState& state);  // F and the energy
  void assemble(const SolveState& state);
  void add_block(const StepProblem& problem, const Block& block);
  bool factor(SolveState& state);
  void find_step(const SolveState& state);
  void correct_step(const SolveState& state);
  double move(SolveState& state, double length);
  double take_step(SolveState& state, double energy_limit);

  std::vector<Block> blocks_;
  std::vector<double> error_;                         // (m) F
  std::vector<double> step_, rest_, impulse_before_;  // (m) dlambda; what a step is to remove of F
  std::vector<double> step_velocity_, row_velocity_;  // (n, 6) M^-1 J^T dlambda; (m) J of it
  std::vector<double> best_impulse_;
  double best_residual_ = 0;
  std::vector<Eigen::Triplet<double>> triplets_;
  Matrix matrix_;
  Eigen::SparseLU<Matrix> lu_;
  std::deque<double> energies_;
};

}  // namespace cleave
