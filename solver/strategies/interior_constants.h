// The constants of the strategy `interior-point`. They are no options of a solve: every run has these values.
//
// Velocities are in m/s where no other unit is named. The velocity scale is the largest |v0| entry, at least
// 1 m/s; d_r is the diagonal of J M^-1 J^T + C.
//
// Under each sentence stand the factorisations with other values, over the 160 problems of
// scripts/ablate_interior_point; with the values here they are 3272. off: the constant has no effect.
// proximal: problems left above the limit until proximal steps followed, where they are not 0.
#pragma once

#include <memory>

#include "solver/solve_state.h"
#include "solver/strategies/strategy.h"

namespace cleave {

struct InteriorConstants {
  // --- Where the iteration starts

  // Rows whose bounds are closer than this, as a velocity d_r (hi - lo), are fixed between them: a slack has
  // no room. tests/solver/interior_point_bounds_test.cpp fails without it.
  // off (0): 3272; 1e-15: 3272; 1e-11: 3272.
  double fixed_width_m_per_s = 1e-13;
  // The same in roundings of the bounds: closer ones leave no digits for a slack.
  // off (0): 3272; 16: 3272; 256: 3272.
  double fixed_roundings = 64;
  // Warm impulses are used where their residual is below this share of the residual without any: those that
  // are not nearly right lie close to the wrong bounds.
  // off (0): 3387; 0.01: 3293; 0.5: 3265; inf: 3783.
  double warm_share = 0.1;
  // Products s z at the start, in mean energies w^2 / d of a row: well inside the bounds.
  // off (0): 4599; 1: 3313; 15: 3271; 60: 3279.
  double start_energy = 30;
  // Least speed d s or z of a row at the start: products are positive even where nothing moves.
  // 1e-06: 3250; 0.0001: 3258; 0.01: 3284.
  double least_speed_m_per_s = 1e-3;
  // Most speed of a row at the start, in speeds of the fastest row: light bodies get no more from the energy.
  // off (inf): 3293; 10: 3276; 1000: 3293.
  double most_speed = 100;
  // A row between two bounds starts at least this share of their distance away from both.
  // 0.125: 3273; 0.5: 3273.
  double inside_share = 0.25;

  // --- Direction and step

  // Share of the way to the nearest bound that a step goes; all of it would make a variable zero.
  // 0.95: 3648; 0.99: 3325; 0.9975: 3251.
  double step_fraction = 0.995;
  // Mehrotra's direction aims at the mean product times this power of the share that the affine step leaves,
  // as he did.
  // 1: 4440; 2: 3510; 4: 3231.
  int target_power = 3;
  // A longest step below this is a poor one: the direction is replaced by one that only centres.
  // off (0): 3249; 0.05: 3263; 0.2: 3279.
  double short_step = 0.1;
  // Share of the mean product that a direction which only centres aims at.
  // 0.15: 3281; 0.6: 3258.
  double centring = 0.3;
  // Centrality corrections of an iteration, at most. Each is one back-substitution, on 200 rocks a fifth of
  // assembly and factorisation.
  // off (0): 3920; 1: 3423; 4: 3208.
  int corrections = 2;
  // A step of this length needs no correction: what is left to gain is not worth a back-substitution.
  // off (1): 3202; 0.5: 3870; 0.9: 3363.
  double long_step = 0.95;
  // How much longer a step a correction aims at.
  // 0.15: 3351; 0.6: 3272.
  double reach = 0.3;
  // Products within [target * band, target / band] after that step are left as they are.
  // off (0): 3276; 0.05: 3246; 0.2: 3274.
  double band = 0.1;
  // A correction is kept when the step gains at least this share of what it was to gain.
  // off (0): 3257; 0.05: 3268; 0.2: 3271.
  double least_gain = 0.1;

  // --- The factored compliance delta, in units of d_r

  // Of the first factorisation, before any rounding was seen: that of the other strategies.
  // 1e-14: 3263; 1e-12: 3277; 1e-10: 3276.
  double first_delta = kFactoredCompliance;
  // Lowest that delta falls to: less loses the soft directions to rounding.
  // off (3e-13): 3248; 1e-15: 3744, 2 proximal; 1e-13: 3210.
  double least_delta = 1e-14;
  // Highest that delta rises to: a larger one rounds less and takes more iterations.
  // off (3e-13): 4370, 4 proximal; 1e-10: 3273; 1e-08: 3272.
  double most_delta = 1e-9;
  // Rounding of a direction, in units of the error it is to remove, above which delta rises.
  // off (inf): 3937, 2 proximal; 0.05: 3256; 0.2: 3269.
  double much_rounding = 0.1;
  // Rounding, likewise, below which delta falls.
  // off (0): 3222; 0.0001: 3277; 0.01: 3271.
  double little_rounding = 1e-3;
  // By which it rises: a digit an iteration.
  // off (1): 3937, 2 proximal; 3: 3281; 30: 3244.
  double delta_rise = 10;
  // By which it falls.
  // off (1): 3222; 0.03: 3254; 0.3: 3245.
  double delta_fall = 0.1;
  // When full steps make the error grow all the same, delta and its least value are raised, so many times.
  // off (0): 6266, 15 proximal; 1: 4606, 6 proximal; 6: 3272.
  int raises = 3;
  // By which they are raised.
  // off (1): 6349, 15 proximal; 3: 4331, 6 proximal; 30: 3271.
  double raise_factor = 10;
  // Errors above this share of the velocity scale may grow, far from the solution.
  // tests/solver/interior_point_bounds_test.cpp fails without it.
  // off (inf): 3272; 0.0001: 3272; 0.01: 3272.
  double settled = 1e-3;
  // A step of this length is a full one: after a shorter one an error may grow.
  // tests/solver/interior_point_bounds_test.cpp fails without it.
  // off (0): 3270; 0.5: 3272; 0.99: 3289.
  double full_step = 0.9;
  // An error above this many times the best one has grown. tests/solver/interior_point_bounds_test.cpp fails
  // without it.
  // off (1): 3263; 1.5: 3271; 4: 3272.
  double growth = 2;
  // Iterations without progress before delta is raised, or before the best iterate is the answer.
  // 1: 3226; 4: 3318.
  int patience = 2;

  // --- The exact solve on the active set ("polish")

  // The first attempt is made below an error, in units of the velocity scale, that depends on the least C_r /
  // d_r, because stiffer rows leave the active set undecided for longer. From this C_r / d_r up it is
  // soft_polish.
  // off (inf): 3284; 1e-05: 3280; 0.001: 3276.
  double soft_compliance = 1e-4;
  // Error of the first attempt on soft problems.
  // off (0): 3380; 1e-06: 3284; 0.0001: 3275; 0.001: 3285.
  double soft_polish = 1e-5;
  // From this C_r / d_r up, and below soft_compliance, it is firm_polish.
  // off (inf): 3300; 1e-10: 3276; 1e-08: 3272.
  double firm_compliance = 1e-9;
  // Error of the first attempt on firm problems.
  // off (0): 3600; 1e-07: 3279; 1e-05: 3287.
  double firm_polish = 1e-6;
  // From this C_r / d_r up, and below firm_compliance, it is stiff_polish.
  // off (inf): 3264; 1e-12: 3280; 1e-10: 3270.
  double stiff_compliance = 1e-11;
  // Error of the first attempt on stiff problems.
  // off (0): 3331; 1e-09: 3280; 1e-07: 3288.
  double stiff_polish = 1e-8;
  // Error of the first attempt on all others.
  // off (0): 3814; 1e-11: 3261; 1e-09: 3265.
  double rigid_polish = 1e-10;
  // A failed attempt is repeated at this share of its error.
  // off (1): 3367; 0.001: 3283; 0.1: 3291.
  double next_polish = 1e-2;
  // Violations up to this share of the target of the solve are none.
  // 0.01: 3272; 1: 3267.
  double polish_accuracy = 0.1;
  // Solves of an attempt, each after flipping the rows that violate their state.
  // off (1): 3351; 2: 3298; 8: 3272.
  int polish_rounds = Settling{}.rounds;
  // Steps of iterative refinement of each of them, at most.
  // off (1): 3314; 4: 3272; 16: 3272.
  int polish_refinements = Settling{}.refinements;
  // An attempt is given up above so many violations, and the next share of the rows: more never came right.
  // off (0): 3281; 1: 3279; 6: 3264.
  int polish_violations = Settling{}.most_violations;
  // That share.
  // off (0): 3305; 0.0025: 3284; 0.01: 3282; 0.05: 3337.
  double polish_violated_share = Settling{}.violated_share;
};

// The strategy with constants of one's own, to measure what each of them does.
std::unique_ptr<Strategy> make_interior_point(const InteriorConstants& constants);

}  // namespace cleave
