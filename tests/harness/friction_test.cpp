// Predicted bounds against a dense twin, the mismatch, and the outer fixed point.
#include "harness/experiment/friction.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <set>
#include <string>

#include "harness/experiment/friction_box.h"
#include "harness/experiment/friction_converged.h"
#include "harness/experiment/friction_mismatch.h"
#include "tests/harness/dense_oracle.h"
#include "tests/harness/extract_test_scene.h"

namespace cleave {
namespace {

// Boxes of 50 kg in a loose column on the ground, off axis and sliding.
std::unique_ptr<OdeWorld> make_column(std::uint64_t seed, int boxes) {
  return make_test_world(
      [=](dWorldID world, dSpaceID space, SceneContent& content) {
        TestRandom random(seed);
        content.geoms.push_back(dCreatePlane(space, 0, 0, 1, 0));
        for (int i = 0; i < boxes; ++i) {
          const dBodyID body = dBodyCreate(world);
          dMass mass;
          dMassSetBoxTotal(&mass, 50, 0.6, 0.6, 0.4);
          dBodySetMass(body, &mass);
          dBodySetPosition(body, random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.199 + 0.398 * i);
          dBodySetLinearVel(body, random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0);
          content.bodies.push_back(body);
          content.geoms.push_back(dCreateBox(space, 0.6, 0.6, 0.4));
          dGeomSetBody(content.geoms.back(), body);
        }
      },
      9.81, true);
}

// A column whose contacts carry made-up impulses over from a previous step.
StepProblem make_column_problem(std::uint64_t seed, int boxes = 4) {
  const auto world = make_column(seed, boxes);
  const std::vector<ContactPoint> contacts = world->collide(8, nullptr);
  StepProblem problem = extract(*world, contacts, {}, ContactMemory());
  TestRandom random(seed);
  for (double& impulse : problem.warm_impulse) impulse = random.uniform(-2, 8);
  return problem;
}

class OracleSolver : public StepSolver {
 public:
  bool uses_partition() const override { return false; }

 private:
  SolveSummary do_solve(const StepProblem& problem, const Parts&, Solution& solution) override {
    const OracleSolution exact = solve_exactly(problem);
    EXPECT_LE(exact.residual, 1e-10);
    solution.impulse.assign(exact.impulse.begin(), exact.impulse.end());
    solution.velocity.assign(exact.velocity.begin(), exact.velocity.end());
    return {};
  }
};

// --- prediction -----------------------------------------------------------------------------------------

// The same sweeps on the dense matrix J M^-1 J^T + C, recomputing every row's slack from scratch.
std::vector<double> slow_prediction(const StepProblem& problem, int sweeps) {
  const int m = problem.row_count(), size = 6 * problem.body_count();
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(m, size), mass = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < problem.body_count(); ++i)
    mass.block<6, 6>(6 * i, 6 * i) = Eigen::Map<const Eigen::Matrix<double, 6, 6>>(&problem.mass[36 * i]);
  for (int r = 0; r < m; ++r)
    for (int side = 0; side < 2; ++side)
      if (const int body = problem.row_body[2 * r + side]; body >= 0)
        for (int k = 0; k < 6; ++k) jacobian(r, 6 * body + k) = problem.jacobian[12 * r + 6 * side + k];
  Eigen::MatrixXd a = jacobian * mass.llt().solve(jacobian.transpose());
  a.diagonal() += Eigen::Map<const Eigen::VectorXd>(problem.compliance.data(), m);
  const Eigen::VectorXd q = jacobian * Eigen::Map<const Eigen::VectorXd>(problem.free_velocity.data(), size) -
                            Eigen::Map<const Eigen::VectorXd>(problem.rhs.data(), m);
  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(m);
  const auto project = [&](int r, double value) {
    if (problem.row_kind[r] != RowKind::friction)
      return std::clamp(value, problem.lower[r], problem.upper[r]);
    const double bound = problem.friction_coefficient[r] * impulse[problem.friction_row[r]];
    return std::clamp(value, -bound, bound);
  };
  for (int r = 0; r < m; ++r) impulse[r] = project(r, problem.warm_impulse[r]);
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (int r = 0; r < m; ++r)
      impulse[r] = project(r, impulse[r] - (a.row(r).dot(impulse) + q[r]) / a(r, r));
  return {impulse.begin(), impulse.end()};
}

TEST(FrictionPrediction, BoundsAgreeWithDenseSweeps) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    StepProblem problem = make_column_problem(seed);
    ExtractOptions options;  // 5 sweeps
    if (seed % 3 == 1) options.bound_sweeps = 0;
    if (seed % 3 == 2) options.bound_sweeps = static_cast<int>(seed);
    const std::vector<double> expected = slow_prediction(problem, options.bound_sweeps);
    const StepProblem before = problem;
    friction_model(FrictionModel::box).set(options, problem);
    for (int r = 0; r < problem.row_count(); ++r) {
      if (problem.row_kind[r] == RowKind::friction) {
        EXPECT_NEAR(problem.upper[r], 0.5 * expected[problem.friction_row[r]], 1e-10) << "seed " << seed;
        EXPECT_EQ(problem.lower[r], -problem.upper[r]);
      } else {
        EXPECT_EQ(problem.lower[r], before.lower[r]);
        EXPECT_EQ(problem.upper[r], before.upper[r]);
      }
    }
    EXPECT_EQ(problem.warm_impulse, before.warm_impulse);
    EXPECT_EQ(find_problem_error(problem), "");
  }
}

TEST(FrictionPrediction, ConstantBoundsAreLeftAlone) {
  const auto world = make_column(1, 3);
  ExtractOptions options;
  options.friction = FrictionModel::constant;
  options.friction_force_n = 60;
  StepProblem problem = extract(*world, world->collide(8, nullptr), options, ContactMemory());
  const std::vector<double> upper = problem.upper;
  predict_friction_bounds(problem);
  EXPECT_EQ(problem.upper, upper);
  const std::vector<double> impulse(problem.row_count(), 3.0);
  EXPECT_EQ(largest_bound_error(problem, impulse), 0);
  EXPECT_TRUE(std::isnan(friction_mismatch(problem, impulse).bound_mismatch));
  EXPECT_TRUE(std::isnan(friction_mismatch(problem, impulse).friction_beyond_share));
}

TEST(FrictionPrediction, WarmStartedBoundsComeCloserThanColdOnes) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    StepProblem cold = make_column_problem(seed, 6);
    std::fill(cold.warm_impulse.begin(), cold.warm_impulse.end(), 0.0);
    StepProblem converged = cold;
    predict_friction_bounds(converged);
    OracleSolver solver;
    Solution solution;
    converge_friction_bounds(converged, solver, {}, solution);
    StepProblem warm = cold;
    warm.warm_impulse = solution.impulse;
    predict_friction_bounds(cold);
    predict_friction_bounds(warm);
    EXPECT_LT(largest_bound_error(warm, solution.impulse), largest_bound_error(cold, solution.impulse))
        << "seed " << seed;
    EXPECT_LT(friction_mismatch(warm, solution.impulse).bound_mismatch,
              friction_mismatch(cold, solution.impulse).bound_mismatch)
        << "seed " << seed;
  }
}

TEST(FrictionPrediction, EmptyProblemsAreFine) {
  StepProblem problem;
  predict_friction_bounds(problem);
  EXPECT_EQ(largest_bound_error(problem, {}), 0);
  EXPECT_TRUE(std::isnan(friction_mismatch(problem, {}).bound_mismatch));
}

// --- mismatch -------------------------------------------------------------------------------------------

// Contacts with mu = 0.5 and the given friction bounds.
StepProblem make_bounds(std::initializer_list<double> bounds) {
  StepProblem problem;
  for (const double bound : bounds) {
    const int normal = problem.row_count();
    for (int side = 0; side < 3; ++side) {
      problem.rhs.push_back(0);
      problem.row_kind.push_back(side == 0 ? RowKind::normal : RowKind::friction);
      problem.friction_row.push_back(side == 0 ? -1 : normal);
      problem.friction_coefficient.push_back(side == 0 ? 0 : 0.5);
      problem.upper.push_back(side == 0 ? std::numeric_limits<double>::infinity() : bound);
      problem.lower.push_back(side == 0 ? 0 : -bound);
    }
  }
  return problem;
}

TEST(FrictionMismatch, WeighsEachBoundWithWhatItsContactCarries) {
  const auto mismatch = [](std::initializer_list<double> bounds, const std::vector<double>& impulse) {
    return friction_mismatch(make_bounds(bounds), impulse).bound_mismatch;
  };
  EXPECT_EQ(mismatch({2, 5}, {4, 0, 0, 10, 0, 0}), 0);
  EXPECT_DOUBLE_EQ(mismatch({2, 6}, {4, 9, 9, 10, 9, 9}), 2.0 / 14);
  EXPECT_DOUBLE_EQ(mismatch({0, 5}, {4, 0, 0, 10, 0, 0}), 4.0 / 14);
  // A contact that carries nothing, or pulls, is measured by what the others carry.
  EXPECT_DOUBLE_EQ(mismatch({1e-6, 5}, {0, 0, 0, 10, 0, 0}), 2e-7);
  EXPECT_DOUBLE_EQ(mismatch({1e-6, 5}, {-3, 0, 0, 10, 0, 0}), 2e-7);
  EXPECT_TRUE(std::isnan(mismatch({1, 0}, std::vector<double>(6, 0.0)))) << "nothing is carried";
}

TEST(FrictionMismatch, CountsRowsThatCarryMoreThanTheirContactAllows) {
  const auto share = [](const std::vector<double>& impulse) {
    return friction_mismatch(make_bounds({9, 9}), impulse).friction_beyond_share;
  };
  EXPECT_EQ(share({4, 2, -2, 10, 5, -5}), 0);
  EXPECT_EQ(share({4, 2 * (1 + 1e-10), -2, 10, 5, -5}), 0) << "rounding";
  EXPECT_EQ(share({4, 2 * (1 + 1e-8), -2, 10, 5, -5}), 0.25);
  EXPECT_EQ(share({4, 3, -3, 10, 0, -5.1}), 0.75);
  EXPECT_EQ(share({0, 1, 0, 10, 0, 0}), 0.25) << "of a contact that carries nothing";
}

TEST(FrictionMismatch, IsNoneOfContactsWithoutBox) {
  StepProblem problem = make_bounds({2, 6});
  problem.contact_set.assign(6, ContactSet::box);
  const std::vector<double> impulse = {4, 9, 9, 10, 9, 9};
  EXPECT_DOUBLE_EQ(friction_mismatch(problem, impulse).bound_mismatch, 2.0 / 14);
  problem.contact_set[3] = ContactSet::cone;
  EXPECT_EQ(friction_mismatch(problem, impulse).bound_mismatch, 0);
  EXPECT_EQ(friction_mismatch(problem, impulse).friction_beyond_share, 1);
  problem.contact_set[0] = ContactSet::coulomb;
  EXPECT_TRUE(std::isnan(friction_mismatch(problem, impulse).bound_mismatch));
  EXPECT_TRUE(std::isnan(friction_mismatch(problem, impulse).friction_beyond_share));
}

TEST(LargestBoundError, IsTheLargestRelativeDifference) {
  EXPECT_EQ(largest_bound_error(make_bounds({2, 5}), std::vector<double>{4, 0, 0, 10, 0, 0}), 0);
  EXPECT_DOUBLE_EQ(largest_bound_error(make_bounds({2, 6}), std::vector<double>{4, 9, 9, 10, 9, 9}), 0.2);
  EXPECT_DOUBLE_EQ(largest_bound_error(make_bounds({0, 5}), std::vector<double>{4, 0, 0, 10, 0, 0}), 1);
}

TEST(LargestBoundError, ContactsThatCarryNothingAreMeasuredAgainstTheStep) {
  // mu lambda = 5 is the largest, so the floor is 5e-6.
  EXPECT_DOUBLE_EQ(largest_bound_error(make_bounds({1e-6, 5}), std::vector<double>{0, 0, 0, 10, 0, 0}), 0.2);
  EXPECT_DOUBLE_EQ(largest_bound_error(make_bounds({1e-6, 5}), std::vector<double>{-3, 0, 0, 10, 0, 0}), 0.2);
  EXPECT_EQ(largest_bound_error(make_bounds({0, 0}), std::vector<double>(6, 0.0)), 0);
}

// --- fixed point ----------------------------------------------------------------------------------------

TEST(ConvergedFriction, BoundsMatchTheSolutionAfterwards) {
  int most_solves = 0, converged_columns = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    StepProblem problem = make_column_problem(seed);
    predict_friction_bounds(problem);
    OracleSolver solver;
    Solution solution;
    const ConvergedBounds result = converge_friction_bounds(problem, solver, {}, solution);
    EXPECT_EQ(result.converged, result.error <= kBoundTolerance) << "seed " << seed;
    EXPECT_TRUE(result.converged || result.solves == kBoundIterationCap) << "seed " << seed;
    EXPECT_EQ(result.error, largest_bound_error(problem, solution.impulse)) << "seed " << seed;
    EXPECT_EQ(result.last_summary.status, SolveStatus::ok);
    // The bounds in the problem are those the solution was found for.
    const OracleSolution again = solve_exactly(problem);
    for (std::size_t k = 0; k < solution.velocity.size(); ++k)
      EXPECT_NEAR(again.velocity[k], solution.velocity[k], 1e-11) << "seed " << seed;
    converged_columns += result.converged;
    most_solves = std::max(most_solves, result.solves);
  }
  std::printf("%d of 30 columns converged, at most %d solves\n", converged_columns, most_solves);
  EXPECT_GE(converged_columns, 25);
  EXPECT_GT(most_solves, 2) << "the first bounds must not have been right already";
}

TEST(ConvergedFriction, SlidingBoxIsBrakedByMuG) {
  const auto world = make_column(1, 1);
  dBodySetLinearVel(world->content().bodies[0], 2, 0, 0);
  ExtractOptions options;
  options.mu = 0.3;
  StepProblem problem = extract(*world, world->collide(8, nullptr), options, ContactMemory());
  for (int r = 0; r < problem.row_count();
       ++r)  // contact without push-out, so the ground carries the weight alone
    if (problem.row_kind[r] == RowKind::normal) problem.rhs[r] = 0;
  predict_friction_bounds(problem);
  OracleSolver solver;
  Solution solution;
  const ConvergedBounds result = converge_friction_bounds(problem, solver, {}, solution);
  EXPECT_TRUE(result.converged);
  double normal = 0;
  for (int r = 0; r < problem.row_count(); ++r)
    if (problem.row_kind[r] == RowKind::normal) normal += solution.impulse[r];
  EXPECT_NEAR(50 * (2 - solution.velocity[0]), 0.3 * normal, 1e-4 * normal);
  EXPECT_NEAR(normal, 50 * 9.81 / 60, 1e-2 * normal);
}

// Normal impulses that jump between two values never settle.
class JumpingSolver : public StepSolver {
 public:
  bool uses_partition() const override { return false; }
  SolveStatus status = SolveStatus::ok;
  int solves = 0;

 private:
  SolveSummary do_solve(const StepProblem& problem, const Parts&, Solution& solution) override {
    solution.impulse.assign(problem.row_count(), ++solves % 2 ? 1.0 : 2.0);
    solution.velocity.assign(problem.free_velocity.size(), 0.0);
    SolveSummary summary;
    summary.status = status;
    return summary;
  }
};

TEST(ConvergedFriction, CapAndFailureAreReported) {
  StepProblem problem = make_column_problem(1);
  JumpingSolver jumping;
  Solution solution;
  const ConvergedBounds capped = converge_friction_bounds(problem, jumping, {}, solution);
  EXPECT_FALSE(capped.converged);
  EXPECT_EQ(capped.solves, kBoundIterationCap);
  EXPECT_EQ(jumping.solves, kBoundIterationCap);
  EXPECT_NEAR(capped.error, 0.5, 1e-12);

  JumpingSolver failing;
  failing.status = SolveStatus::not_converged;
  const ConvergedBounds failed = converge_friction_bounds(problem, failing, {}, solution);
  EXPECT_FALSE(failed.converged);
  EXPECT_EQ(failed.solves, 1);
  EXPECT_EQ(failed.last_summary.status, SolveStatus::not_converged);
}

TEST(FrictionModels, TableNamesEveryModelOnce) {
  std::set<std::string> names;
  std::set<FrictionModel> models;
  for (const FrictionModelEntry& entry : friction_models()) {
    EXPECT_TRUE(names.insert(entry.name).second);
    EXPECT_TRUE(models.insert(entry.model).second);
    EXPECT_NE(std::string(entry.help), "");
    EXPECT_NE(std::string(entry.reference), "");
  }
  EXPECT_EQ(names, (std::set<std::string>{"none", "constant", "box", "box-converged", "cone", "coulomb"}));
}

}  // namespace
}  // namespace cleave
