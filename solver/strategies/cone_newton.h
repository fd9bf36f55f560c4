// The semi-smooth Newton method that ends the interior point where contacts have cones, whose curved surface
// leaves no active set to read off.
//
// The conditions of all rows are F = lambda - P(lambda - w / d) = 0, with P the nearest point of the impulse
// set. The derivative of P at p = lambda - w / d is symmetric; its eigenvectors e and eigenvalues theta are,
// with u = p_t / |p_t|,
//
//     a row with bounds      theta = 1 between them, 0 beyond
//     a cone, p inside       theta = 1;   P(p) = 0: theta = 0
//     a cone, p outside      theta = 1 along (1, mu u), mu P_n / |p_t| across u in the tangent plane, 0 along
//                            (mu, -u)
//
// Along e, a Newton step asks (1 - theta) dlambda_e + theta dw_e / d = -F_e. Directions of theta = 0 are
// moved by -F_e at once (w then becomes w'), which leaves for the others rows of the kernel's system,
//
//     D_e^-1 = C + d (1 - theta) / theta,    f_e = -d F_e / theta - (w' - w)_e,
//
// exact where the rows of a contact have one compliance.
//
// Under Coulomb's law w_n + mu |w_t| takes the place of w_n, with the change of mu |w_t| along the step
// (step_shift.h), which is found the more exactly the faster the steps converge. They are halved until the
// energy sum_r d_r F_r^2 (of a contact its largest F) is below the greatest of the last few: where every step
// has to lower it, many stay short. On piles and towers that are not stiff it mostly converges from the
// impulses of the step before, on others from where the interior point stalls.
//
// Source: Qi and Sun, "A nonsmooth version of Newton's method", Math. Program. 58, 1993; the derivative:
// Fukushima, Luo and Tseng, "Smoothing functions for second-order-cone complementarity problems", SIAM J.
// Optim. 12, 2002; the energy: Grippo, Lampariello and Lucidi, "A nonmonotone line search technique for
// Newton's method", SIAM J. Numer. Anal. 23, 1986; how exactly: Eisenstat and Walker, "Choosing the forcing
// terms in an inexact Newton method", SIAM J. Sci. Comput. 17, 1996.
#pragma once

#include <vector>

#include "solver/solve_state.h"
#include "solver/strategies/step_shift.h"

namespace cleave {

class ConeNewton {
 public:
  // Steps from the present impulses until the residual is at most `target` (m/s) or falls too slowly. Each
  // back-substitution counts as a refinement. Returns the least residual, whose impulses stay, with the shift
  // of their velocities.
  double run(SolveState& state, double target);

  // Where an attempt is worth its factorisations: the residual in units of the velocity scale, by the least
  // C_r / d_r.
  static double first_residual(double least_compliance);

 private:
  bool find_step(SolveState& state);
  double take_step(SolveState& state);
  double energy_to_beat() const;
  double shift_accuracy() const;
  ImpulseSet::Misses misses(SolveState& state);
  bool falls() const;
  void linearize_rows(SolveState& state, int first, int last) const;
  void linearize_cone(SolveState& state, const FrictionCone& cone);
  void solve(SolveState& state);

  bool has_coulomb_ = false;
  StepShift shift_;
  int without_fall_ = 0, most_without_fall_ = 1;  // steps of a cone
  std::vector<double> energies_;                  // before every step and after the last
  std::vector<double> chunk_energy_;              // scratch
  std::vector<double> wanted_;                    // (m) on the rows of cones, w - d F / theta
  std::vector<char> slides_;                      // (cones) under Coulomb's law
  std::vector<double> impulse_before_, slack_before_, best_impulse_;  // (m)
};

}  // namespace cleave
