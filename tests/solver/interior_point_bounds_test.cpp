// The interior point on bounds that leave no interior, or hardly any, against the enumeration of all active
// sets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "solver/registry.h"
#include "solver/step_solver.h"
#include "tests/solver/enumeration_oracle.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kSeeds = 300;

// Bounds of one row about an impulse: the row's own at the solution of another set of bounds, so that bounds
// often hold with a slack of next to nothing.
using Bounds = std::pair<double, double> (*)(SeededRandom& random, double about);

std::pair<double, double> fixed(SeededRandom& random, double about) {
  const double value = random.chance(0.3) ? 0 : random.chance(0.5) ? about : random.uniform(-2, 2);
  return {value, value};
}
std::pair<double, double> at_least(SeededRandom& random, double about) {
  return {random.chance(0.5) ? about : 0, kInfinity};
}
std::pair<double, double> at_most(SeededRandom& random, double about) {
  return {-kInfinity, random.chance(0.5) ? about : 0};
}
std::pair<double, double> unbounded(SeededRandom&, double) { return {-kInfinity, kInfinity}; }
std::pair<double, double> hair(SeededRandom& random, double about) {  // down to a few units in the last place
  const double centre = random.chance(0.5) ? about : 0;
  const double width = random.log_uniform(1e-16, 1e-3) * std::max(1e-3, std::abs(about));
  return {centre - (random.chance(0.5) ? width : 0), centre + width};
}
std::pair<double, double> vast(SeededRandom& random, double) {  // finite, and never reached
  return {-random.log_uniform(1e6, 1e15), random.log_uniform(1e6, 1e15)};
}
std::pair<double, double> far_from_zero(SeededRandom& random, double) {
  const double bound = random.log_uniform(1, 1e4);
  return random.chance(0.5) ? std::pair{bound, kInfinity} : std::pair{-kInfinity, -bound};
}

struct BoundKind {
  const char* name;
  Bounds make;
};
constexpr BoundKind kKinds[] = {{"fixed", fixed},
                                {"at_least", at_least},
                                {"at_most", at_most},
                                {"unbounded", unbounded},
                                {"hair", hair},
                                {"vast", vast},
                                {"far_from_zero", far_from_zero}};

// kind: of every row; nullptr: each row draws its own.
StepProblem make_degenerate(std::uint64_t seed, const BoundKind* kind, bool mixed_masses) {
  StepProblem problem = make_small_problem(seed, {.most_rows = 8, .mass_ratio = 2});
  SeededRandom random(seed);
  for (int i = 0; i < problem.body_count() && mixed_masses; ++i) {
    const double factor = std::pow(1e3, random.integer(0, 2));  // 1, 1e3 or 1e6 kg
    for (int k = 0; k < 36; ++k) problem.mass[36 * i + k] *= factor;
  }
  const std::vector<double> about = solve_by_enumeration(problem).impulse;
  for (int r = 0; r < problem.row_count(); ++r) {
    const BoundKind& chosen = kind != nullptr ? *kind : kKinds[random.integer(0, std::ssize(kKinds) - 1)];
    std::tie(problem.lower[r], problem.upper[r]) = chosen.make(random, about[r]);
  }
  return problem;
}

class InteriorPointBoundsTest : public testing::TestWithParam<std::string> {
 protected:
  static void expect_oracle(const BoundKind* kind, bool mixed_masses, int seeds) {
    const auto solver = make_step_solver("interior-point:" + GetParam(), {});
    for (int seed = 0; seed < seeds; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const StepProblem problem = make_degenerate(seed, kind, mixed_masses);
      ASSERT_EQ(find_problem_error(problem), "");
      Solution solution = cold_start(problem);
      const SolveSummary summary = solver->solve(problem, own_parts(problem.body_count()), solution);
      EXPECT_TRUE(is_exact(problem, summary, solution));
      EXPECT_EQ(summary.strategy, "interior-point");
      EXPECT_EQ(summary.fallbacks, 0);
      const OracleSolution oracle = solve_by_enumeration(problem);
      EXPECT_TRUE(velocities_agree(problem, solution.velocity, oracle.velocity, 1e-9));
      for (int r = 0; r < problem.row_count(); ++r) {
        EXPECT_GE(solution.impulse[r], problem.lower[r]) << "row " << r;
        EXPECT_LE(solution.impulse[r], problem.upper[r]) << "row " << r;
      }
    }
  }
};

TEST_P(InteriorPointBoundsTest, EachKindOfBoundAlone) {
  for (const BoundKind& kind : kKinds) {
    SCOPED_TRACE(kind.name);
    expect_oracle(&kind, false, kSeeds / 6);
  }
}

TEST_P(InteriorPointBoundsTest, AllKindsOfBoundsTogether) { expect_oracle(nullptr, false, kSeeds); }

TEST_P(InteriorPointBoundsTest, AllKindsOfBoundsOnBodiesFromOneToAMillionKilograms) {
  expect_oracle(nullptr, true, kSeeds);
}

std::vector<std::string> kernel_names() {
  std::vector<std::string> names;
  for (const KernelRow& row : kernel_table())
    if (row.traits.runs_as == nullptr) names.emplace_back(row.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Kernels, InteriorPointBoundsTest, testing::ValuesIn(kernel_names()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace cleave
