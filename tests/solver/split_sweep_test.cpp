// Sweeps on copies of bodies: what a copy is, that one domain is Gauss-Seidel, and that no sweep raises the
// energy.
#include "solver/split_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "solver/gauss_seidel.h"
#include "tests/solver/iterative_checks.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

struct Swept {
  explicit Swept(const StepProblem& problem, int threads = 1) : tasks(clock, threads) {
    clock.start();
    step.prepare(problem, &tasks);
    impulse.assign(problem.row_count(), 0.0);
    velocity = problem.free_velocity;
  }

  StageClock clock;
  ParallelTasks tasks;
  PreparedStep step;
  SplitSweep split;
  std::vector<double> impulse, velocity;
};

std::vector<int> random_domains(const PreparedStep& step, int domains, std::uint64_t seed) {
  SeededRandom random(seed);
  std::vector<int> domain_of_group(step.groups().size());
  for (int& domain : domain_of_group) domain = random.integer(0, domains - 1);
  return domain_of_group;
}

TEST(SplitSweepTest, ABodyHasACopyInEveryDomainOfItsRows) {
  const StepProblem problem = make_pile(1, {.columns = 3, .rows = 2, .layers = 3});
  Swept swept(problem);
  for (const int domains : {1, 3, 40}) {
    const std::vector<int> domain_of_group = random_domains(swept.step, domains, domains);
    std::set<std::pair<int, int>> copies;
    for (std::size_t g = 0; g < domain_of_group.size(); ++g) {
      copies.insert({swept.step.groups()[g].body_a, domain_of_group[g]});
      copies.insert({swept.step.groups()[g].body_b, domain_of_group[g]});
    }
    swept.split.bind(swept.step, domain_of_group, domains);
    for (int body = 0; body < problem.body_count(); ++body)
      EXPECT_EQ(swept.split.copies_of(body), std::ranges::count(copies, body, &std::pair<int, int>::first));
  }
}

TEST(SplitSweepTest, OneDomainIsGaussSeidelToTheByte) {
  const StepProblem pile = make_pile(2, {.columns = 3, .rows = 2, .layers = 3, .mass_ratio = 100});
  const StepProblem chain = make_chain(2, {.links = 20, .extra_joints = 4, .closed = true});
  for (const StepProblem& problem : {pile, chain}) {
    Swept swept(problem), plain(problem);
    swept.split.bind(swept.step, std::vector<int>(swept.step.groups().size(), 0), 1);
    for (int sweep = 0; sweep < 4; ++sweep) swept.split.run(swept.impulse, swept.velocity, swept.tasks);
    gauss_seidel_sweeps(plain.step, 4, plain.impulse, plain.velocity, nullptr);
    EXPECT_TRUE(same_bytes(swept.impulse, plain.impulse));
    EXPECT_TRUE(same_bytes(swept.velocity, plain.velocity));
    EXPECT_TRUE(same_bytes(iterate_by("split-domains@sweeps=4", problem).solution.impulse, plain.impulse));
  }
}

TEST(SplitSweepTest, NoSweepRaisesTheEnergyAndVelocitiesFollowTheImpulses) {
  for (const double ratio : {1.0, 1000.0}) {
    const StepProblem problem = make_pile(3, {.columns = 3, .rows = 3, .layers = 3, .mass_ratio = ratio});
    for (const int domains : {2, 7, 200}) {
      SCOPED_TRACE(testing::Message() << "mass ratio " << ratio << ", " << domains << " domains");
      Swept swept(problem);
      swept.split.bind(swept.step, random_domains(swept.step, domains, 5), domains);
      double last = 0;
      for (int sweep = 0; sweep < 30; ++sweep) {
        swept.split.run(swept.impulse, swept.velocity, swept.tasks);
        const double energy = energy_of(problem, swept.impulse);
        EXPECT_LT(energy, last) << "sweep " << sweep;
        last = energy;
      }
      std::vector<double> velocity(swept.velocity.size());
      swept.step.velocity(swept.impulse, velocity);
      EXPECT_TRUE(velocities_agree(problem, swept.velocity, velocity, 1e-11));
    }
  }
}

// Two rows that hold one body up, alike: each domain moves its half of the mass by what the whole body asks
// for.
TEST(SplitSweepTest, TwoRowsAlikeShareWhatOneWouldDo) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 2, {1, 1, 1}, {0, 0, -3, 0, 0, 0});
  append_body(problem, 1, {1, 1, 1}, {});
  RowSpec floor;
  floor.jacobian_a = {0, 0, 1, 0, 0, 0};
  floor.lower = 0;
  floor.kind = RowKind::normal;
  append_row(problem, floor);
  floor.constraint = 1;
  floor.body_a = 1;  // ends the run of rows between the same bodies
  append_row(problem, floor);
  floor.constraint = 2;
  floor.body_a = 0;
  append_row(problem, floor);
  const Iterated found = iterate_by("jacobi-split@sweeps=1", problem);
  EXPECT_NEAR(found.solution.impulse[0], 3, 1e-12);
  EXPECT_EQ(found.solution.impulse[1], 0);
  EXPECT_NEAR(found.solution.impulse[2], 3, 1e-12);
  EXPECT_NEAR(found.solution.velocity[2], 0, 1e-12);
}

TEST(SplitSweepTest, FewerCopiesConvergeFaster) {
  const StepProblem problem = make_pile(4, {.columns = 3, .rows = 3, .layers = 4, .cfm = 1e-3});
  const auto energy = [&](const std::string& solver, int parts) {
    return energy_of(problem, iterate_by(solver, problem, parts).solution.impulse);
  };
  const double pgs = energy("pgs@sweeps=20", 1), few = energy("split-domains@sweeps=20", 3),
               many = energy("split-domains@sweeps=20", problem.body_count()),
               pairs = energy("jacobi-split@sweeps=20", 1);
  EXPECT_LT(pgs, few);
  EXPECT_LT(few, many);
  EXPECT_LT(many, pairs);
}

}  // namespace
}  // namespace cleave
