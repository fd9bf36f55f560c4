// The constants of the strategy `interior-point`. They are no options of a solve: every run has these values.
//
// Velocities are in m/s where no other unit is named. The velocity scale is the largest |v0| entry, at least
// 1 m/s; d_r is the diagonal of J M^-1 J^T + C.
#pragma once

#include <memory>

#include "solver/solve_state.h"
#include "solver/strategies/strategy.h"

namespace cleave {

struct InteriorConstants {
  // --- Where the iteration starts

  // Rows whose bounds are closer than this, as a velocity d_r (hi - lo), are fixed between them.
  double fixed_width_m_per_s = 1e-13;
  // The same in roundings of the bounds: closer ones leave no digits for a slack.
  double fixed_roundings = 64;
  // Warm impulses are used where their residual is below this share of the residual without any: those that
  // are not nearly right lie close to the wrong bounds.
  double warm_share = 0.1;
  // Products s z at the start, in mean energies w^2 / d of a row: well inside the bounds.
  double start_energy = 30;
  // Least speed d s or z of a row at the start: products are positive even where nothing moves.
  double least_speed_m_per_s = 1e-3;
  // Most speed of a row at the start, in speeds of the fastest row: the lightest body next to a heavy one
  // would start too far from its bounds.
  double most_speed = 100;
  // A row between two bounds starts at least this share of their distance away from both.
  double inside_share = 0.25;

  // --- Direction and step

  // Share of the way to the nearest bound that a step goes; all of it would make a variable zero.
  double step_fraction = 0.995;
  // Mehrotra's direction aims at the mean product times this power of the share that the affine step leaves.
  int target_power = 3;
  // A longest step below this is a poor one: the direction is replaced by one that only centres.
  double short_step = 0.1;
  // Share of the mean product that a direction which only centres aims at.
  double centring = 0.3;
  // Centrality corrections of an iteration, at most; each is one back-substitution.
  int corrections = 2;
  // A step of this length needs no correction.
  double long_step = 0.95;
  // How much longer a step a correction aims at.
  double reach = 0.3;
  // Products within [target * band, target / band] after that step are left as they are.
  double band = 0.1;
  // A correction is kept when the step gains at least this share of `reach`.
  double least_gain = 0.1;

  // --- The factored compliance delta, in units of d_r

  // Of the first factorisation.
  double first_delta = kFactoredCompliance;
  // Lowest and highest that it follows the rounding to: less cannot be factored, more takes many iterations.
  double least_delta = 1e-14, most_delta = 1e-9;
  // Rounding of the directions, in units of the error they are to remove, above which delta rises and below
  // which it falls, and by which factors.
  double much_rounding = 0.1, little_rounding = 1e-3;
  double delta_rise = 10, delta_fall = 0.1;
  // When full steps make the error grow all the same, delta and its least value are raised, so many times and
  // by this factor.
  int raises = 3;
  double raise_factor = 10;
  // Errors above this share of the velocity scale may grow.
  double settled = 1e-3;
  // A step of this length is a full one.
  double full_step = 0.9;
  // An error that grows by more than this, from the best one, has grown.
  double growth = 2;
  // Iterations without progress before delta is raised, or before the best iterate is the answer.
  int patience = 2;

  // --- The exact solve on the active set ("polish")

  // First attempt at an error, in units of the velocity scale, by the least C_r / d_r: stiffer rows leave the
  // active set undecided for longer. From soft_compliance up at soft_polish, and so on; rigid_polish is for
  // everything below stiff_compliance.
  double soft_compliance = 1e-4, soft_polish = 1e-5;
  double firm_compliance = 1e-9, firm_polish = 1e-6;
  double stiff_compliance = 1e-11, stiff_polish = 1e-8;
  double rigid_polish = 1e-10;
  // A failed attempt is repeated at this share of its error.
  double next_polish = 1e-2;
  // Violations up to this share of the target of the solve are none.
  double polish_accuracy = 0.1;
  // Solves of an attempt, each after flipping the rows that violate their state.
  int polish_rounds = Settling{}.rounds;
  // Steps of iterative refinement of each of them, at most.
  int polish_refinements = Settling{}.refinements;
  // An attempt is given up above so many violations and this share of the rows: more never came right.
  int polish_violations = Settling{}.most_violations;
  double polish_violated_share = Settling{}.violated_share;
};

// The strategy with constants of one's own, to measure what each of them does.
std::unique_ptr<Strategy> make_interior_point(const InteriorConstants& constants);

}  // namespace cleave
