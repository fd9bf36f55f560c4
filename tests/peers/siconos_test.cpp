// Siconos on Coulomb's law: closed forms of a block on a plane, its error against the formula, piles against
// the law.
#include "harness/peers/siconos.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "harness/peers/dense_problem.h"
#include "harness/peers/peer_solver.h"
#include "tests/peers/coulomb_problems.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

const Settings kSettings({{"peer-max-rows", "3000"},
                          {"peer-timeout-s", "300"},
                          {"peer-tolerance", "1e-10"},
                          {"peer-iterations", "100000"}});
constexpr PeerFunction kBoth[] = {solve_siconos_nsgs, solve_siconos_newton};

// A point of 2 kg, or another mass, that comes down at 1 m/s and moves at `speed` along `angle`.
StepProblem landing_point(double speed, double angle_rad, double mu, double mass_kg = 2) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, mass_kg, {1, 1, 1},
              {speed * std::cos(angle_rad), speed * std::sin(angle_rad), -1, 0, 0, 0});
  append_row(problem, {.jacobian_a = {0, 0, 1}, .compliance = 1e-9, .lower = 0, .kind = RowKind::normal});
  for (int t = 0; t < 2; ++t) {
    RowSpec row{.compliance = 1e-9, .kind = RowKind::friction, .friction_row = 0, .friction_coefficient = mu};
    row.jacobian_a[t] = 1;
    append_row(problem, row);
  }
  return with_coulomb(problem);
}

// The largest gap to the law over all contacts, from w = A lambda - g, without a projection: what Siconos
// measures by.
double worst_gap(const StepProblem& problem, std::span<const double> impulse) {
  const DenseProblem dense = make_dense_problem(problem);
  std::vector<double> w(dense.rows);
  for (int r = 0; r < dense.rows; ++r) {
    w[r] = -dense.right_side[r];
    for (int c = 0; c < dense.rows; ++c) w[r] += dense.matrix[dense.rows * r + c] * impulse[c];
  }
  double worst = 0;
  for (int r = 0; r < dense.rows; r += 3) {
    const double mu = problem.friction_coefficient[r + 1];
    const double friction = std::hypot(impulse[r + 1], impulse[r + 2]), slip = std::hypot(w[r + 1], w[r + 2]);
    const double power = impulse[r + 1] * w[r + 1] + impulse[r + 2] * w[r + 2];
    worst = std::max({worst, -impulse[r], -w[r], std::min(impulse[r], w[r]), friction - mu * impulse[r],
                      std::abs(power + mu * impulse[r] * slip)});  // friction against the slip, in full
  }
  return worst;
}

TEST(Siconos, StopsWhatIsSlowAndSlidesWithTheBoundElse) {
  for (const PeerFunction solve : kBoth)
    for (const double degrees : {0.0, 15.0, 30.0, 45.0})
      for (const double speed : {0.4, 0.6}) {
        const double angle = degrees * std::numbers::pi / 180, mu = 0.5;
        const StepProblem problem = landing_point(speed, angle, mu);
        const PeerAnswer answer = solve(problem, problem.warm_impulse, kSettings);
        ASSERT_TRUE(answer.claims_success) << answer.message;
        const double friction = 2 * std::min(speed, mu * 1.0);
        EXPECT_NEAR(answer.impulse[0], 2, 1e-7);
        EXPECT_NEAR(answer.impulse[1], -friction * std::cos(angle), 1e-7) << degrees;
        EXPECT_NEAR(answer.impulse[2], -friction * std::sin(angle), 1e-7) << degrees;
      }
}

TEST(Siconos, SolvesPiles) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const StepProblem pile =
        with_coulomb(make_pile(seed, {.columns = 2, .rows = 1, .layers = 2, .cfm = 1e-4, .mu = 0.3}));
    for (const PeerFunction solve : kBoth) {
      const PeerAnswer answer = solve(pile, pile.warm_impulse, kSettings);
      EXPECT_TRUE(answer.claims_success) << answer.message << ", seed " << seed;
      EXPECT_LE(worst_gap(pile, answer.impulse), 1e-8) << seed;
      EXPECT_LE(siconos_error(pile, answer.impulse), 1e-9) << seed;
    }
  }
}

// | r - P(r - (u_n + mu |u_t|, u_t)) | / |q|, for one contact that is to be moved along t1.
TEST(Siconos, ErrorIsTheFormula) {
  const StepProblem problem = landing_point(0.6, 0, 0.5);
  // No impulse: u = q = (-1, 0.6, 0), r - (u_n + mu |u_t|, u_t) = (0.7, -0.6, 0), outside of the cone.
  const double n = (0.7 + 0.5 * 0.6) / (1 + 0.5 * 0.5);
  EXPECT_NEAR(siconos_error(problem, std::vector<double>(3, 0.0)),
              std::hypot(n, 0.5 * n) / std::hypot(1, 0.6), 1e-12);
  EXPECT_NEAR(siconos_error(problem, std::vector<double>{2, -1, 0}), 0, 1e-8);
  // Impulses far above |q| do not count: a slip of 0.1 m/s inside of the cone stays one.
  const StepProblem heavy = landing_point(0.1, 0, 0.5, 1e6);
  EXPECT_NEAR(siconos_error(heavy, std::vector<double>{1e6, 0, 0}),
              std::hypot(0.1, 0.5 * 0.1 + 1e-3) / std::hypot(1, 0.1), 1e-9);  // rounding of impulses
}

// Where impulses are far above |q| Siconos by itself is content with more.
TEST(Siconos, IsRunToTheErrorAskedForAlsoUnderHeavyBodies) {
  const StepProblem pile = with_coulomb(
      make_pile(1, {.columns = 2, .rows = 1, .layers = 2, .cfm = 1e-4, .mu = 0.3, .mass_ratio = 1e3}));
  for (const PeerFunction solve : kBoth) {
    const PeerAnswer answer = solve(pile, pile.warm_impulse, kSettings);
    EXPECT_TRUE(answer.claims_success) << answer.message;
    EXPECT_LE(siconos_error(pile, answer.impulse), 1e-10);
  }
}

TEST(Siconos, RefusesWhatIsNotItsOwn) {
  const StepProblem pile = make_pile(1, {.columns = 1, .rows = 1, .layers = 1, .cfm = 1e-4});
  Solution solution = cold_start(pile);
  PeerSolver solver("siconos-nsgs", solve_siconos_nsgs, ContactSet::coulomb, {}, kSettings);
  const SolveSummary boxes = solver.solve(pile, {}, solution);
  EXPECT_EQ(boxes.status, SolveStatus::refused);
  EXPECT_EQ(boxes.message, "solver siconos-nsgs takes contacts of Coulomb's law; that of row 0 has boxes");
  const StepProblem chain = make_chain(1, {.links = 3});  // no contacts
  EXPECT_THROW(siconos_error(chain, chain.warm_impulse), std::invalid_argument);
  solution = cold_start(chain);
  EXPECT_EQ(solver.solve(chain, {}, solution).status, SolveStatus::refused);
}

}  // namespace
}  // namespace cleave
