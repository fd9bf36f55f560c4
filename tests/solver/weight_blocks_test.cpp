// Kernels with 3x3 blocks in D: one linear solve against the same system in turned scalar rows, and against
// the equations with D written out.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "solver/impulse_set.h"
#include "solver/kernels/kernel.h"
#include "solver/registry.h"
#include "tests/solver/kernel_by_name.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/turned_boxes.h"

namespace cleave {
namespace {

constexpr int kSeeds = 6;

struct LinearSystem {
  std::vector<double> d, f_v, f_r;
  std::vector<WeightBlock> blocks;
};

struct Increments {
  std::vector<double> dv, dlambda;
};

double largest(const std::vector<double>& x) {
  double most = 0;
  for (const double entry : x) most = std::max(most, std::abs(entry));
  return most;
}

double relative_difference(const std::vector<double>& actual, const std::vector<double>& expected) {
  double most = 0;
  for (std::size_t i = 0; i < actual.size(); ++i) most = std::max(most, std::abs(actual[i] - expected[i]));
  return most / largest(expected);
}

// Weights as an active set has them: four decades, some rows at a bound.
LinearSystem make_system(const StepProblem& problem, SeededRandom& random) {
  LinearSystem system;
  for (int r = 0; r < problem.row_count(); ++r) {
    system.d.push_back(random.chance(0.2) ? 0 : random.log_uniform(1e-2, 1e2));
    system.f_r.push_back(random.uniform(-1, 1));
  }
  for (int i = 0; i < 6 * problem.body_count(); ++i) system.f_v.push_back(random.uniform(-1, 1));
  return system;
}

class WeightBlocksTest : public testing::TestWithParam<std::string> {
 protected:
  static Increments solve(const StepProblem& problem, const std::vector<int>& parts,
                          const LinearSystem& system, int threads = 1) {
    StageClock clock;
    clock.start();
    ParallelTasks tasks(clock, threads);
    PreparedStep step;
    step.prepare(problem);
    const std::unique_ptr<Kernel> kernel = make_kernel(GetParam());
    kernel->analyze(step, parts, tasks);
    EXPECT_TRUE(kernel->factor({system.d, system.blocks}, tasks));
    Increments x{std::vector<double>(system.f_v.size()), std::vector<double>(system.f_r.size())};
    kernel->solve(system.f_v, system.f_r, x.dv, x.dlambda, tasks);
    return x;
  }
};

// A pile with contacts inside parts, between parts and with the ground.
StepProblem make_pile_of(int seed) {
  return make_pile(seed, {.columns = 2, .rows = 2, .layers = 3, .mass_ratio = 10});
}

std::vector<std::vector<int>> partitions_of(const StepProblem& problem, SeededRandom& random) {
  const int n = problem.body_count();
  return {single_part(n), own_parts(n), sliced_parts(n, 3), random_parts(random, n, 4)};
}

TEST_P(WeightBlocksTest, TurnedBoxesAgreeWithTheSameRowsTurned) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SeededRandom random(seed);
    const StepProblem problem = turn_boxes(make_pile_of(seed), seed), turned = in_turned_rows(problem);
    ImpulseSet set;
    set.bind(problem);
    LinearSystem blocks = make_system(problem, random), rows = blocks;
    blocks.blocks.assign(set.axes().begin(), set.axes().end());
    ASSERT_GT(blocks.blocks.size(), 20u);
    for (const std::vector<int>& parts : partitions_of(problem, random)) {
      const Increments x = solve(problem, parts, blocks), expected = solve(turned, parts, rows);
      EXPECT_LE(relative_difference(x.dv, expected.dv), 1e-12);
      EXPECT_LE(relative_difference(x.dlambda, expected.dlambda), 1e-12);
    }
  }
}

// Blocks of one to three rows with any basis, rows outside of them scalar; every third block is singular.
// Half of them come after the others.
void add_blocks(const StepProblem& problem, SeededRandom& random, LinearSystem& system) {
  for (const int r : contacts_of(problem)) {
    WeightBlock block{r + random.integer(0, 1), random.integer(1, 3), {}};
    if (block.first_row != r) block.row_count = std::min(block.row_count, 2);
    for (double& entry : block.basis) entry = random.uniform(-1, 1);
    for (int k = 0; k < block.row_count; ++k) block.basis[k * (block.row_count + 1)] += 2;
    system.d[block.first_row] = random.chance(1.0 / 3) ? 0 : random.log_uniform(1e-2, 1e2);
    system.blocks.push_back(block);
  }
  std::stable_partition(system.blocks.begin(), system.blocks.end(),
                        [](const WeightBlock& block) { return block.first_row % 2; });
}

// B as one matrix (m, m).
Eigen::MatrixXd bases_of(const LinearSystem& system) {
  const auto m = static_cast<Eigen::Index>(system.d.size());
  Eigen::MatrixXd bases = Eigen::MatrixXd::Identity(m, m);
  for (const WeightBlock& block : system.blocks) {
    const int size = block.row_count;
    bases.block(block.first_row, block.first_row, size, size) =
        Eigen::Map<const Eigen::MatrixXd>(block.basis.data(), size, size);
  }
  return bases;
}

// A system whose f_r is in rows, as a kernel takes it, and a kernel's answer in rows.
LinearSystem along_bases(LinearSystem system) {
  const Eigen::Map<const Eigen::VectorXd> f_r(system.f_r.data(), std::ssize(system.f_r));
  const Eigen::VectorXd turned = bases_of(system).transpose() * f_r;
  system.f_r.assign(turned.begin(), turned.end());
  return system;
}
std::vector<double> impulses_in_rows(const LinearSystem& system, const std::vector<double>& dlambda) {
  const Eigen::VectorXd turned =
      bases_of(system) * Eigen::Map<const Eigen::VectorXd>(dlambda.data(), std::ssize(dlambda));
  return {turned.begin(), turned.end()};
}

Increments solve_written_out(const StepProblem& p, const LinearSystem& system) {
  const int n = p.body_count(), m = p.row_count();
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(6 * n, 6 * n), jacobian = Eigen::MatrixXd::Zero(m, 6 * n);
  for (int k = 0; k < 36 * n; ++k) mass(k / 36 * 6 + k % 36 / 6, k / 36 * 6 + k % 6) = p.mass[k];
  for (int k = 0; k < 12 * m; ++k) {
    const int body = p.row_body[2 * (k / 12) + k % 12 / 6];
    if (body >= 0) jacobian(k / 12, 6 * body + k % 6) = p.jacobian[k];
  }
  const Eigen::MatrixXd bases = bases_of(system);
  const Eigen::MatrixXd d =
      bases * Eigen::Map<const Eigen::VectorXd>(system.d.data(), m).asDiagonal() * bases.transpose();
  const Eigen::Map<const Eigen::VectorXd> f_v(system.f_v.data(), 6 * n), f_r(system.f_r.data(), m);
  const Eigen::VectorXd dv =
      (mass + jacobian.transpose() * d * jacobian).fullPivLu().solve(f_v + jacobian.transpose() * d * f_r);
  const Eigen::VectorXd dlambda = d * (f_r - jacobian * dv);
  return {{dv.begin(), dv.end()}, {dlambda.begin(), dlambda.end()}};
}

enum Place { ground, inside, cut };
Place place_of(const StepProblem& problem, const std::vector<int>& parts, int row) {
  const int a = problem.row_body[2 * row], b = problem.row_body[2 * row + 1];
  return b < 0 ? ground : parts[a] == parts[b] ? inside : cut;
}

TEST_P(WeightBlocksTest, AnySymmetricBlocksSolveTheEquationsWithDWrittenOut) {
  int seen[3][4] = {};  // blocks by place and number of rows
  for (int seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SeededRandom random(seed);
    const StepProblem problem = make_pile_of(seed);
    LinearSystem system = make_system(problem, random);
    add_blocks(problem, random, system);
    const Increments expected = solve_written_out(problem, system);
    for (const std::vector<int>& parts : partitions_of(problem, random)) {
      for (const WeightBlock& block : system.blocks)
        ++seen[place_of(problem, parts, block.first_row)][block.row_count];
      const Increments x = solve(problem, parts, along_bases(system));
      const Increments twice = solve(problem, parts, along_bases(system), 2);
      EXPECT_LE(relative_difference(x.dv, expected.dv), 1e-11);
      EXPECT_LE(relative_difference(impulses_in_rows(system, x.dlambda), expected.dlambda), 1e-11);
      EXPECT_EQ(x.dv, twice.dv);  // on two threads
      EXPECT_EQ(x.dlambda, twice.dlambda);
    }
  }
  for (const auto& of_place : seen)
    for (int rows = 1; rows <= 3; ++rows) EXPECT_GE(of_place[rows], 10) << rows << " rows";
}

// The next factorisation takes other blocks, or none.
TEST_P(WeightBlocksTest, BlocksChangeFromFactorToFactor) {
  const StepProblem problem = make_pile_of(1);
  const std::vector<int> parts = sliced_parts(problem.body_count(), 3);
  SeededRandom random(1);
  LinearSystem scalar = make_system(problem, random), blocks = scalar;
  add_blocks(problem, random, blocks);
  StageClock clock;
  clock.start();
  ParallelTasks tasks(clock, 1);
  PreparedStep step;
  step.prepare(problem);
  const std::unique_ptr<Kernel> kernel = make_kernel(GetParam());
  kernel->analyze(step, parts, tasks);
  for (const LinearSystem* system : {&blocks, &scalar, &blocks}) {
    ASSERT_TRUE(kernel->factor({system->d, system->blocks}, tasks));
    Increments x{std::vector<double>(system->f_v.size()), std::vector<double>(system->f_r.size())};
    kernel->solve(system->f_v, system->f_r, x.dv, x.dlambda, tasks);
    const Increments fresh = solve(problem, parts, *system);
    EXPECT_EQ(x.dv, fresh.dv);
    EXPECT_EQ(x.dlambda, fresh.dlambda);
  }
}

std::vector<std::string> kernel_names() {
  std::vector<std::string> names;
  for (const KernelRow& row : kernel_table()) names.emplace_back(row.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Kernels, WeightBlocksTest, testing::ValuesIn(kernel_names()), [](const auto& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace cleave
