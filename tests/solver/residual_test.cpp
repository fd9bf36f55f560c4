#include "solver/residual.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/solver/enumeration_oracle.h"
#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kSeeds = 300;

// The judge's twin: the formulas of the header with dense matrices, in double.
struct DenseJudge {
  Eigen::MatrixXd mass, jacobian, effective;
  Eigen::VectorXd free_velocity, rhs;

  explicit DenseJudge(const StepProblem& p) {
    const int n = p.body_count(), m = p.row_count();
    mass = Eigen::MatrixXd::Zero(6 * n, 6 * n);
    for (int k = 0; k < 36 * n; ++k) mass(k / 36 * 6 + k % 36 / 6, k / 36 * 6 + k % 6) = p.mass[k];
    jacobian = Eigen::MatrixXd::Zero(m, 6 * n);
    for (int k = 0; k < 12 * m; ++k) {
      const int body = p.row_body[2 * (k / 12) + k % 12 / 6];
      if (body >= 0) jacobian(k / 12, 6 * body + k % 6) = p.jacobian[k];
    }
    free_velocity = Eigen::Map<const Eigen::VectorXd>(p.free_velocity.data(), 6 * n);
    rhs = Eigen::Map<const Eigen::VectorXd>(p.rhs.data(), m);
    effective = jacobian * mass.fullPivLu().solve(jacobian.transpose());
    for (int r = 0; r < m; ++r) effective(r, r) += p.compliance[r];
  }

  double row_residual(const StepProblem& p, const std::vector<double>& impulse, int r) const {
    const Eigen::Map<const Eigen::VectorXd> lambda(impulse.data(), p.row_count());
    const double slack = effective.row(r).dot(lambda) + jacobian.row(r).dot(free_velocity) - rhs[r];
    const double diagonal = effective(r, r);
    return diagonal * std::abs(lambda[r] - std::clamp(lambda[r] - slack / diagonal, p.lower[r], p.upper[r]));
  }
};

std::vector<double> random_impulse(SeededRandom& random, int rows) {
  std::vector<double> impulse(rows);
  for (double& entry : impulse) entry = random.uniform(-3, 3);
  return impulse;
}

TEST(ResidualTest, IsZeroAtTheOraclesSolution) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StepProblem problem = make_small_problem(seed);
    const OracleSolution oracle = solve_by_enumeration(problem);
    const ResidualReport report = judge(problem, oracle.impulse);
    EXPECT_TRUE(report.exact) << "seed " << seed;
    EXPECT_LE(report.residual_m_per_s, 0.1 * report.limit_m_per_s) << "seed " << seed;
    for (std::size_t i = 0; i < report.velocity.size(); ++i) {
      EXPECT_NEAR(report.velocity[i], oracle.velocity[i], 1e-10) << "seed " << seed;
    }
  }
}

TEST(ResidualTest, AgreesWithDenseRecomputation) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StepProblem problem = make_small_problem(seed);
    SeededRandom random(seed);
    const std::vector<double> impulse = random_impulse(random, problem.row_count());
    const DenseJudge dense(problem);
    const ResidualReport report = judge(problem, impulse);
    double all = 0, bilateral = 0, normal = 0, friction = 0;
    for (int r = 0; r < problem.row_count(); ++r) {
      const double residual = dense.row_residual(problem, impulse, r);
      double& of_kind = problem.row_kind[r] == RowKind::bilateral ? bilateral
                        : problem.row_kind[r] == RowKind::normal  ? normal
                                                                  : friction;
      of_kind = std::max(of_kind, residual);
      all = std::max(all, residual);
    }
    EXPECT_NEAR(report.residual_m_per_s, all, 1e-11 * (1 + all)) << "seed " << seed;
    EXPECT_NEAR(report.residual_bilateral_m_per_s, bilateral, 1e-11 * (1 + all)) << "seed " << seed;
    EXPECT_NEAR(report.residual_normal_m_per_s, normal, 1e-11 * (1 + all)) << "seed " << seed;
    EXPECT_NEAR(report.residual_friction_m_per_s, friction, 1e-11 * (1 + all)) << "seed " << seed;
  }
}

// Impulses in their range, at its ends and beyond, and slacks small and large beside what the row can be
// moved by: the judge looks at the diagonal in some of these cases only.
TEST(ResidualTest, EveryRowAgreesWithDenseRecomputation) {
  int rows_at_bounds = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StepProblem problem = make_small_problem(seed);
    SeededRandom random(seed);
    std::vector<double> impulse = solve_by_enumeration(problem).impulse;
    for (int r = 0; r < problem.row_count(); ++r) {
      const double end = random.chance(0.5) ? problem.lower[r] : problem.upper[r];
      if (random.chance(0.3) && std::isfinite(end)) impulse[r] = end;
      if (random.chance(0.3)) impulse[r] += random.log_uniform(1e-9, 10) * (random.chance(0.5) ? 1 : -1);
      rows_at_bounds += impulse[r] == problem.lower[r] || impulse[r] == problem.upper[r];
    }
    const DenseJudge dense(problem);
    const std::vector<double> residuals = row_residuals(problem, impulse);
    for (int r = 0; r < problem.row_count(); ++r) {
      const double expected = dense.row_residual(problem, impulse, r);
      EXPECT_NEAR(residuals[r], expected, 1e-10 * (1 + expected)) << "seed " << seed << " row " << r;
    }
  }
  EXPECT_GT(rows_at_bounds, 300);
}

// Each entry of a mass beside its diagonal may be all that there is.
TEST(ResidualTest, MassesOfAnyPatternAgreeWithDenseRecomputation) {
  const StepProblem problem = make_small_problem(1);
  SeededRandom random(1);
  const std::vector<double> impulse = random_impulse(random, problem.row_count());
  const int body = problem.row_body[0];
  for (int i = 1; i < 6; ++i) {
    for (int j = 0; j < i; ++j) {
      for (const bool is_alone : {true, false}) {
        StepProblem coupled = problem;
        double* mass = &coupled.mass[36 * body];
        if (is_alone) std::fill_n(mass, 36, 0.0);
        for (int k = 0; k < 6; ++k) mass[7 * k] = 5 + k;
        mass[6 * i + j] = mass[6 * j + i] = 2;
        const DenseJudge dense(coupled);
        const std::vector<double> residuals = row_residuals(coupled, impulse);
        for (int r = 0; r < problem.row_count(); ++r)
          EXPECT_NEAR(residuals[r], dense.row_residual(coupled, impulse, r), 1e-11) << i << " " << j;
      }
    }
  }
}

// Of some rows: their residuals and the velocities of their bodies are those of the whole, and all others are
// left alone.
TEST(ResidualTest, OnlyWhatIsAskedForIsWritten) {
  int bodies_left_alone = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StepProblem problem = make_small_problem(seed);
    SeededRandom random(seed);
    const std::vector<double> impulse = random_impulse(random, problem.row_count());
    const std::vector<double> all_residuals = row_residuals(problem, impulse),
                              all_velocities = judge(problem, impulse).velocity;
    std::vector<char> asked(problem.row_count(), 0), is_needed(problem.body_count(), 0);
    for (int row = 0; row < problem.row_count(); ++row) {
      asked[row] = random.chance(0.3);
      for (const int body : {problem.row_body[2 * row], problem.row_body[2 * row + 1]})
        if (asked[row] && body >= 0) is_needed[body] = 1;
    }
    std::vector<double> velocity(problem.free_velocity.size(), 7.0);
    const std::vector<double> residuals = row_residuals(problem, impulse, asked, velocity);
    for (int row = 0; row < problem.row_count(); ++row)
      EXPECT_EQ(residuals[row], asked[row] ? all_residuals[row] : 0) << "seed " << seed << " row " << row;
    for (std::size_t k = 0; k < velocity.size(); ++k)
      EXPECT_EQ(velocity[k], is_needed[k / 6] ? all_velocities[k] : 7) << "seed " << seed << " entry " << k;
    bodies_left_alone += static_cast<int>(std::ranges::count(is_needed, 0));
  }
  EXPECT_GT(bodies_left_alone, 100);
}

// A first look sees what the judge sees, but for rounding, and writes as little.
TEST(ResidualTest, ARoughLookDiffersByRoundingAlone) {
  int rounded = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StepProblem problem = make_small_problem(seed);
    SeededRandom random(seed);
    const std::vector<double> impulse = random_impulse(random, problem.row_count());
    std::vector<char> asked(problem.row_count(), 0);
    for (char& row : asked) row = random.chance(0.7);
    std::vector<double> velocity(problem.free_velocity.size(), 7.0), rough_velocity = velocity;
    const std::vector<double> residuals = row_residuals(problem, impulse, asked, velocity),
                              rough = rough_row_residuals(problem, impulse, asked, rough_velocity);
    const double speed =
        *std::ranges::max_element(velocity, {}, [](double entry) { return std::abs(entry); });
    for (int row = 0; row < problem.row_count(); ++row) {
      EXPECT_NEAR(rough[row], residuals[row], 1e-13 * (1 + residuals[row] + std::abs(speed)))
          << "seed " << seed;
      rounded += rough[row] != residuals[row];
    }
    for (std::size_t k = 0; k < velocity.size(); ++k)
      EXPECT_NEAR(rough_velocity[k], velocity[k], 1e-13 * (1 + std::abs(speed))) << "seed " << seed;
  }
  EXPECT_GT(rounded, 100);
}

TEST(ResidualTest, MassThatIsNotPositiveDefiniteIsNeverExact) {
  StepProblem problem = make_small_problem(0);
  const std::vector<double> impulse = solve_by_enumeration(problem).impulse;
  ASSERT_TRUE(judge(problem, impulse).exact);
  for (const double entry : {0.0, -1.0}) {
    for (int k = 0; k < 6; ++k) {
      StepProblem wrong = problem;
      const int body = problem.row_body[0];
      wrong.mass[36 * body + 7 * k] = entry;
      const ResidualReport report = judge(wrong, impulse);
      EXPECT_FALSE(report.exact) << entry << " at " << k;
      EXPECT_TRUE(std::isnan(report.velocity[6 * body])) << entry << " at " << k;
    }
  }
}

TEST(ResidualTest, EnergyAgreesWithDenseRecomputation) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StepProblem problem = make_small_problem(seed);
    SeededRandom random(seed);
    const std::vector<double> impulse = random_impulse(random, problem.row_count());
    const DenseJudge dense(problem);
    const Eigen::Map<const Eigen::VectorXd> lambda(impulse.data(), problem.row_count());
    const Eigen::VectorXd& v0 = dense.free_velocity;
    const Eigen::VectorXd v = v0 + dense.mass.fullPivLu().solve(dense.jacobian.transpose() * lambda);
    const double before = 0.5 * v0.dot(dense.mass * v0);
    const double after = 0.5 * v.dot(dense.mass * v);
    const double work = lambda.dot(dense.rhs);
    const ResidualReport report = judge(problem, impulse);
    const double scale = 1 + before + after + std::abs(work);
    EXPECT_NEAR(report.kinetic_energy_j, after, 1e-12 * scale) << "seed " << seed;
    EXPECT_NEAR(report.energy_excess_j, after - before - work, 1e-12 * scale) << "seed " << seed;
  }
}

// An impulse lambda_r + e of a row makes w_r + A_rr e, so the row's own residual is |A_rr e| whatever its
// state was.
TEST(ResidualTest, OnePerturbedRowGivesExactlyItsPerturbation) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StepProblem problem = make_small_problem(seed);
    const OracleSolution oracle = solve_by_enumeration(problem);
    const DenseJudge dense(problem);
    SeededRandom random(seed);
    const int perturbed = random.integer(0, problem.row_count() - 1);
    std::vector<double> impulse = oracle.impulse;
    const double step_m_per_s = random.chance(0.5) ? 1e-6 : -1e-6;
    impulse[perturbed] += step_m_per_s / dense.effective(perturbed, perturbed);

    double expected = 0;
    for (int r = 0; r < problem.row_count(); ++r) {
      expected = std::max(expected, dense.row_residual(problem, impulse, r));
    }
    EXPECT_NEAR(dense.row_residual(problem, impulse, perturbed), 1e-6, 1e-10) << "seed " << seed;
    const ResidualReport report = judge(problem, impulse);
    EXPECT_GE(report.residual_m_per_s, 1e-6 - 1e-10) << "seed " << seed;
    EXPECT_NEAR(report.residual_m_per_s, expected, 1e-10) << "seed " << seed;
    EXPECT_FALSE(report.exact) << "seed " << seed;
  }
}

TEST(ResidualTest, SeesRoundingSizedErrorsUnderHeavyLoad) {
  // 1e6 kg on 1 kg on the floor, C = 1e-8: impulses of 1.6e5 N s, of which the light body keeps next to
  // nothing.
  StepProblem problem;
  problem.h_s = kTestStep_s;
  const double fall_m_per_s = 9.81 * kTestStep_s;
  append_body(problem, 1, {1, 1, 1}, {0, 0, -fall_m_per_s, 0, 0, 0});
  append_body(problem, 1e6, {1, 1, 1}, {0, 0, -fall_m_per_s, 0, 0, 0});
  RowSpec row;
  row.compliance = 1e-8;
  row.jacobian_a = {0, 0, 1, 0, 0, 0};
  append_row(problem, row);
  row.body_a = 1;
  row.body_b = 0;
  row.jacobian_b = {0, 0, -1, 0, 0, 0};
  append_row(problem, row);
  const OracleSolution oracle = solve_by_enumeration(problem);
  EXPECT_LE(judge(problem, oracle.impulse).residual_m_per_s, 1e-10);
  std::vector<double> impulse = oracle.impulse;
  impulse[0] += 2e-9;
  EXPECT_FALSE(judge(problem, impulse).exact);
}

TEST(ResidualTest, SumsCancellingImpulsesWithoutLoss) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 1, {1, 1, 1}, {});
  RowSpec row;
  row.jacobian_a = {1, 0, 0, 0, 0, 0};
  row.rhs = 0.1;
  for (int r = 0; r < 3; ++r) append_row(problem, row);
  const ResidualReport report =
      judge(problem, std::vector<double>{0.1, 1e8, -1e8});  // double would give 0.1 + 6e-9
  EXPECT_NEAR(report.velocity[0], 0.1, 1e-11);
  EXPECT_TRUE(report.exact);
}

TEST(ResidualTest, ExactStepsGainNoEnergyWhereZeroIsAllowed) {
  SmallProblemOptions options;
  options.zero_inside_bounds = true;
  for (int seed = 0; seed < 2 * kSeeds; ++seed) {
    const StepProblem problem = make_small_problem(seed, options);
    const ResidualReport report = judge(problem, solve_by_enumeration(problem).impulse);
    ASSERT_TRUE(report.exact) << "seed " << seed;
    EXPECT_LE(report.energy_excess_j, 1e-12 * std::max(1.0, report.kinetic_energy_j)) << "seed " << seed;
  }
}

TEST(ResidualTest, TooStrongAnImpulseGainsEnergy) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 2, {1, 1, 1}, {0, 0, -1, 0, 0, 0});
  RowSpec floor;
  floor.jacobian_a = {0, 0, 1, 0, 0, 0};
  floor.lower = 0;
  append_row(problem, floor);
  const ResidualReport report = judge(problem, std::vector<double>{6.0});
  EXPECT_DOUBLE_EQ(report.velocity[2], 2);      // -1 + 6 / 2
  EXPECT_DOUBLE_EQ(report.energy_excess_j, 3);  // (2 * 4 - 2 * 1) / 2
  EXPECT_DOUBLE_EQ(report.kinetic_energy_j, 4);
  EXPECT_DOUBLE_EQ(report.residual_m_per_s, 2);  // w = v
}

TEST(ResidualTest, LimitGrowsWithTheFreeVelocity) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 1, {1, 1, 1}, {0, -0.5, 0, 0, 0, 0});
  EXPECT_EQ(judge(problem, {}).limit_m_per_s, 1e-9);
  problem.free_velocity[4] = -20;
  const ResidualReport report = judge(problem, {});
  EXPECT_EQ(report.largest_free_velocity_m_per_s, 20);
  EXPECT_DOUBLE_EQ(report.limit_m_per_s, 20e-9);
  EXPECT_TRUE(report.exact);
  EXPECT_EQ(report.velocity, problem.free_velocity);
}

TEST(ResidualTest, RelativeResidualIsInTheProblemsOwnVelocities) {
  int compared = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    SeededRandom random(seed);
    const StepProblem problem = make_small_problem(seed);
    const DenseJudge twin(problem);
    const ResidualReport report = judge(problem, random_impulse(random, problem.row_count()));
    const Eigen::VectorXd before = twin.jacobian * twin.free_velocity;
    const double scale = std::max({twin.free_velocity.lpNorm<Eigen::Infinity>(),
                                   before.lpNorm<Eigen::Infinity>(), twin.rhs.lpNorm<Eigen::Infinity>()});
    if (scale == 0) continue;  // all at rest, see below
    ++compared;
    EXPECT_NEAR(report.residual_relative, report.residual_m_per_s / scale, 1e-12 * report.residual_relative)
        << "seed " << seed;
  }
  EXPECT_GT(compared, kSeeds / 2);
}

// The limit is in metres per second: where everything is a million times slower, it accepts an error that the
// relative residual shows.
TEST(ResidualTest, RelativeResidualSeesSmallVelocities) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 2, {1, 1, 1}, {0, 0, -1e-6, 0, 0, 0});
  RowSpec floor;
  floor.jacobian_a = {0, 0, 1, 0, 0, 0};
  floor.lower = 0;
  append_row(problem, floor);
  const ResidualReport report = judge(problem, std::vector<double>{2e-6 * (1 - 2e-4)});
  EXPECT_TRUE(report.exact);
  EXPECT_NEAR(report.residual_m_per_s, 2e-10, 1e-20);
  EXPECT_NEAR(report.residual_relative, 2e-4, 1e-14);

  problem.free_velocity[2] = -1;  // the same in metres per second
  const ResidualReport usual = judge(problem, std::vector<double>{2 * (1 - 2e-4)});
  EXPECT_FALSE(usual.exact);
  EXPECT_NEAR(usual.residual_relative, 2e-4, 1e-14);
}

TEST(ResidualTest, RelativeResidualOfNothingIsZero) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 1, {1, 1, 1}, {0, 0, 0, 0, 0, 0});
  EXPECT_EQ(judge(problem, {}).residual_relative, 0);
  RowSpec floor;
  floor.jacobian_a = {0, 0, 1, 0, 0, 0};
  floor.lower = 0;
  append_row(problem, floor);
  EXPECT_EQ(judge(problem, std::vector<double>{0.0}).residual_relative, 0);
  EXPECT_EQ(judge(problem, std::vector<double>{1.0}).residual_relative, kInfinity);
  EXPECT_TRUE(std::isnan(judge(problem, std::vector<double>{kNan}).residual_relative));
}

TEST(ResidualTest, IgnoresTheUnusedBlockOfAStaticRow) {
  StepProblem problem = make_small_problem(3);
  while (std::count(problem.row_body.begin(), problem.row_body.end(), -1) == 0) {
    problem = make_small_problem(problem.row_count() + 100);
  }
  const std::vector<double> impulse(problem.row_count(), 0.5);
  const double before = judge(problem, impulse).residual_m_per_s;
  for (int r = 0; r < problem.row_count(); ++r) {
    if (problem.row_body[2 * r + 1] != -1) continue;
    for (int k = 6; k < 12; ++k) problem.jacobian[12 * r + k] = 1e3;
  }
  EXPECT_EQ(judge(problem, impulse).residual_m_per_s, before);
}

TEST(ResidualTest, NanAndInfinityAreNeverExact) {
  for (int seed = 0; seed < 50; ++seed) {
    const StepProblem problem = make_small_problem(seed);
    const OracleSolution oracle = solve_by_enumeration(problem);
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
      for (int r = 0; r < problem.row_count(); ++r) {
        std::vector<double> impulse = oracle.impulse;
        impulse[r] = bad;
        const ResidualReport report = judge(problem, impulse);
        EXPECT_TRUE(std::isnan(report.residual_m_per_s)) << "seed " << seed << " row " << r;
        EXPECT_TRUE(std::isnan(report.energy_excess_j)) << "seed " << seed << " row " << r;
        EXPECT_FALSE(report.exact) << "seed " << seed << " row " << r;
      }
    }
  }
}

TEST(ResidualTest, NanInTheProblemIsNeverExact) {
  for (int seed = 0; seed < 50; ++seed) {
    const StepProblem problem = make_small_problem(seed);
    const OracleSolution oracle = solve_by_enumeration(problem);
    for (const auto array : {&StepProblem::free_velocity, &StepProblem::rhs, &StepProblem::compliance}) {
      StepProblem damaged = problem;
      (damaged.*array).back() = kNan;
      EXPECT_FALSE(judge(damaged, oracle.impulse).exact) << "seed " << seed;
    }
    StepProblem damaged = problem;
    damaged.mass[36 * damaged.row_body[0]] = -1;  // no mass matrix: nothing can be vouched for
    EXPECT_FALSE(judge(damaged, oracle.impulse).exact) << "seed " << seed;
  }
}

TEST(ResidualTest, HugeImpulsesAreNotExact) {
  const StepProblem problem = make_pile(1, {});
  EXPECT_FALSE(judge(problem, std::vector<double>(problem.row_count(), 1e308)).exact);
}

TEST(ResidualTest, RowThatNothingCanMoveIsJudgedByItsSlack) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 1, {1, 1, 1}, {});
  RowSpec row;  // no Jacobian, no compliance
  row.lower = 0;
  row.rhs = -1;  // w = 1
  append_row(problem, row);
  EXPECT_EQ(judge(problem, std::vector<double>{0.0}).residual_m_per_s, 0);
  EXPECT_GT(judge(problem, std::vector<double>{0.5}).residual_m_per_s, 0);
  problem.rhs[0] = 1;  // w = -1 for every impulse: no solution
  EXPECT_GT(judge(problem, std::vector<double>{0.0}).residual_m_per_s, 0);
}

}  // namespace
}  // namespace cleave
