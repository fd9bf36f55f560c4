// Parts as no partitioner makes them: trees of any arity whose leaves lie at all depths, bodies dealt out at
// random, leaves without any. Whatever splits along them finds the velocities of the oracle.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "solver/registry.h"
#include "solver/step_solver.h"
#include "tests/solver/part_trees.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

constexpr double kTolerance = 1e-9;
constexpr int kSeeds = 5, kTrees = 2, kMostLeaves = 12;

// How far the deepest leaf is below the highest one.
int depth_range(const PartTree& tree, int leaves) {
  const std::vector<int>& parent = tree.parent_of_part;
  std::vector<int> depth(parent.size(), 0);
  for (int node = static_cast<int>(parent.size()) - 2; node >= 0; --node)
    depth[node] = depth[parent[node]] + 1;
  const auto [least, most] = std::minmax_element(depth.begin(), depth.begin() + leaves);
  return *most - *least;
}

TEST(RandomTreeTest, ComesInEveryShape) {
  constexpr int kBodies = 20;
  std::set<int> arities;
  int uneven = 0, sparse = 0, last_is_empty = 0;
  for (int seed = 0; seed < 100; ++seed) {
    SeededRandom random(seed);
    const int leaves = random.integer(1, kMostLeaves);
    const PartTree tree = random_tree(random, kBodies, leaves);
    ASSERT_EQ(PartsCheck().find_error(tree.parts(), kBodies), "") << "seed " << seed;
    for (int node = leaves; node < std::ssize(tree.parent_of_part); ++node)
      arities.insert(static_cast<int>(std::ranges::count(tree.parent_of_part, node)));
    const std::set<int> with_bodies(tree.part_of_body.begin(), tree.part_of_body.end());
    uneven += depth_range(tree, leaves) >= 2;
    sparse += std::ssize(with_bodies) < leaves;
    last_is_empty += *with_bodies.rbegin() < leaves - 1;
  }
  EXPECT_EQ(arities, (std::set<int>{2, 3, 4, 5}));
  EXPECT_GE(uneven, 10);
  EXPECT_GE(sparse, 10);
  EXPECT_GE(last_is_empty, 10);
}

// All kernels that split, and the one on the whole system, under every strategy that must be exact.
std::vector<std::string> compared_solvers() {
  std::vector<std::string> names;
  for (const StrategyRow& strategy : strategy_table()) {
    for (const KernelRow& kernel : kernel_table()) {
      if (!kernel.traits.splits && std::string_view(kernel.name) != "monolithic") continue;
      if (!strategy.traits.always_exact || strategy.make == nullptr || !runs_on(strategy, kernel)) continue;
      names.push_back(std::string(strategy.name) + ":" + kernel.name);
    }
  }
  return names;
}

// The links of a chain after the bodies that are there, and its joints.
void append_chain(StepProblem& problem, const StepProblem& chain) {
  const int first_link = problem.body_count(), first_joint = 1 + problem.row_constraint.back();
  problem.mass.insert(problem.mass.end(), chain.mass.begin(), chain.mass.end());
  problem.free_velocity.insert(problem.free_velocity.end(), chain.free_velocity.begin(),
                               chain.free_velocity.end());
  for (int r = 0; r < chain.row_count(); ++r) {
    const int b = chain.row_body[2 * r + 1];
    RowSpec row;
    row.body_a = first_link + chain.row_body[2 * r];
    row.body_b = b < 0 ? -1 : first_link + b;
    std::copy_n(chain.jacobian.begin() + 12 * r, 6, row.jacobian_a.begin());
    std::copy_n(chain.jacobian.begin() + 12 * r + 6, 6, row.jacobian_b.begin());
    row.rhs = chain.rhs[r];
    row.compliance = chain.compliance[r];
    row.constraint = first_joint + chain.row_constraint[r];
    append_row(problem, row);
  }
}

// The centres of two bodies move as one.
void tie(StepProblem& problem, int body_a, int body_b, double cfm) {
  const int constraint = 1 + problem.row_constraint.back();
  for (int k = 0; k < 3; ++k) {
    RowSpec row{.body_a = body_a, .body_b = body_b, .compliance = cfm / kTestStep_s};
    row.jacobian_a[k] = 1;
    row.jacobian_b[k] = -1;
    row.constraint = constraint;
    append_row(problem, row);
  }
}

// Contacts and joints: a pile, and a chain from the world to one of its blocks. That the chain can give way
// keeps impulses small where nothing else does.
StepProblem make_tied_pile(SeededRandom& random, double cfm) {
  const int seed = random.integer(1, 1000), columns = random.integer(1, 3), layers = random.integer(2, 3);
  const int links = random.integer(6, 12), extra_joints = random.integer(0, 2);
  StepProblem problem = make_pile(seed, {.columns = columns, .rows = 2, .layers = layers, .cfm = cfm});
  const int block = random.integer(0, problem.body_count() - 1);
  append_chain(problem, make_chain(seed, {.links = links, .extra_joints = extra_joints, .cfm = cfm}));
  tie(problem, problem.body_count() - 1, block, cfm);
  return problem;
}

void expect_velocities(const StepProblem& problem, const Parts& parts, const std::vector<double>& velocity) {
  const std::vector<std::string> solvers = compared_solvers();
  ASSERT_GE(solvers.size(), 8u);
  for (const std::string& name : solvers) {
    SCOPED_TRACE(name);
    Solution solution = cold_start(problem);
    EXPECT_TRUE(is_exact(problem, make_step_solver(name)->solve(problem, parts, solution), solution));
    EXPECT_TRUE(velocities_agree(problem, solution.velocity, velocity, kTolerance));
  }
}

class RandomTreesTest : public testing::TestWithParam<double> {};

TEST_P(RandomTreesTest, GiveTheVelocitiesOfTheOracle) {
  for (int seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SeededRandom random(seed);
    const StepProblem problem = make_tied_pile(random, GetParam());
    ASSERT_EQ(find_problem_error(problem), "");
    const int bodies = problem.body_count();
    Solution oracle = cold_start(problem);
    ASSERT_TRUE(
        is_exact(problem, make_step_solver("dense")->solve(problem, single_part(bodies), oracle), oracle));
    for (int k = 0; k < kTrees; ++k) {
      const int leaves = random.integer(2, std::min(kMostLeaves, bodies));
      const PartTree tree = random_tree(random, bodies, leaves);
      SCOPED_TRACE("tree " + testing::PrintToString(tree.parent_of_part));
      expect_velocities(problem, tree.parts(), oracle.velocity);
      expect_velocities(problem, tree.part_of_body, oracle.velocity);  // its leaves side by side
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Compliances, RandomTreesTest, testing::Values(1e-5, 1e-9),
                         [](const auto& info) { return info.param < 1e-7 ? "stiff" : "soft"; });

}  // namespace
}  // namespace cleave
