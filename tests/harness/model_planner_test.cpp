// Planned solves against solves of all rows: the same velocities on all scenes and on random worlds, whatever
// was left out.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <random>
#include <set>
#include <string>

#include "harness/experiment/algorithms.h"
#include "harness/experiment/chosen_kernel.h"
#include "harness/experiment/friction_cone.h"
#include "harness/experiment/model_planner.h"
#include "harness/experiment/problem_graph.h"
#include "scenarios/scene.h"
#include "solver/registry.h"
#include "tests/harness/planned_scene.h"
#include "tests/harness/run_program.h"
#include "tests/harness/world_stepper.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

// The fall, the impact, at rest, hit by the ball.
const std::vector<PlannedScene> kScenes = {
    {{{"scene", "chain_drop"}, {"links", "24"}}, 90},
    {{{"scene", "log_tower"}, {"layers", "5"}, {"logs", "3"}}, 90},
    {{{"scene", "rock_pile"}, {"bodies", "30"}}, 120},
    {{{"scene", "rock_pile"}, {"bodies", "30"}, {"mu", "0"}}, 60},
    {{{"scene", "rock_pile"}, {"bodies", "20"}, {"seed", "2"}, {"rock-shape", "sphere"}}, 100},
    {{{"scene", "rock_pile"}, {"bodies", "20"}, {"seed", "3"}, {"cfm", "1e-8"}}, 100},
    {{{"scene", "large_rock_pile"}, {"bodies", "30"}, {"seed", "4"}}, 120},
    {{{"scene", "silo"}}, 20},
    {{{"scene", "crane"}}, 20},
    {{{"scene", "mixed_site"}, {"links", "50"}, {"rings", "1"}, {"dt", "0.001"}, {"cfm", "1e-8"}}, 20},
    {{{"scene", "ladder_stack"}, {"copies", "2"}}, 40},
    {{{"scene", "ladder_heavy_top"}, {"cfm", "1e-8"}}, 40},
    {{{"scene", "ladder_alternating"}, {"cfm", "1e-8"}}, 40},
    {{{"scene", "ladder_incline"}, {"mu", "0.3"}}, 40},
    {{{"scene", "ladder_chain"}, {"angle", "60"}}, 40},
    {{{"scene", "ladder_loop"}}, 40},
    {{{"scene", "ladder_free"}, {"boxes", "3"}}, 40},
    {{{"scene", "file@path=" + (fs::path(CLEAVE_SOURCE_DIR) / "scenarios/files/pile.toml").string()}}, 60},
};

struct Solved {
  Solution solution;
  ModelCounts counts;
  SolveSummary summary;
};

Solved solve_with(const StepProblem& problem, const std::vector<RowPlan>& plan) {
  const std::unique_ptr<StepSolver> solver = make_step_solver("exact", {});
  Solved solved{{problem.warm_impulse, {}}, {}, {}};
  solved.solution.velocity.assign(problem.free_velocity.size(), 0.0);
  solved.summary =
      ModelPlanner().solve(*solver, problem, one_part(problem), plan, solved.solution, solved.counts);
  return solved;
}

void expect_full_answer(const StepProblem& problem, const Solved& solved) {
  EXPECT_EQ(solved.summary.status, SolveStatus::ok) << solved.summary.message;
  const ResidualReport report = judge(problem, solved.solution.impulse);
  EXPECT_TRUE(report.exact) << report.residual_m_per_s;
  const Solved full = solve_with(problem, std::vector<RowPlan>(problem.rhs.size(), RowPlan::solved));
  EXPECT_EQ(full.counts.passes, 1);
  EXPECT_LE(largest_difference(solved.solution.velocity, full.solution.velocity), 1e-9);
}

struct PlannedRows {
  int left_out = 0, returned = 0, all = 0;
};

using Plan = std::function<std::vector<RowPlan>(const StepProblem& problem)>;

std::vector<RowPlan> planned(const StepProblem& problem) { return ModelPlanner().plan(problem); }

PlannedRows expect_to_move_as_with_all_rows(const PlannedScene& scene, const std::string& name,
                                            const Plan& plan = planned) {
  WorldStepper world = stepper_of(scene);
  PlannedRows rows;
  for (int step = 0; step < scene.steps; ++step) {
    world.step();
    SCOPED_TRACE(name + ", step " + std::to_string(step));
    const StepProblem& problem = world.problem();
    const Solved solved = solve_with(problem, plan(problem));
    expect_full_answer(problem, solved);
    if (testing::Test::HasFailure()) break;
    EXPECT_EQ(solved.counts.passes > 1, solved.counts.rows_returned > 0);
    rows.left_out += solved.counts.rows_left_out;
    rows.returned += solved.counts.rows_returned;
    rows.all += problem.row_count();
  }
  return rows;
}

TEST(ModelPlanner, ScenesMoveAsWithAllRows) {
  std::set<std::string> moved;
  for (const PlannedScene& scene : kScenes) {
    const std::string& name = scene.options.at("scene");
    const PlannedRows rows = expect_to_move_as_with_all_rows(scene, name);
    if (HasFailure()) return;
    EXPECT_LE(2 * rows.returned, rows.left_out) << "of " << rows.all << " rows, " << name;
    moved.insert(name.substr(0, name.find('@')));
  }
  for (const SceneEntry& scene : scenes()) EXPECT_TRUE(moved.contains(scene.name)) << scene.name;
}

PlannedRows move_random_worlds(int steps, const Plan& plan) {
  const TemporaryDirectory directory;
  PlannedRows rows;
  for (int seed = 1; seed <= 30 && !testing::Test::HasFailure(); ++seed) {
    const PlannedRows found = expect_to_move_as_with_all_rows(random_scene(seed, steps, directory),
                                                              "seed " + std::to_string(seed), plan);
    rows.left_out += found.left_out;
    rows.returned += found.returned;
    rows.all += found.all;
  }
  return rows;
}

TEST(ModelPlanner, RandomWorldsMoveAsWithAllRows) {
  const PlannedRows rows = move_random_worlds(150, planned);
  EXPECT_GT(rows.left_out, 1000) << "of " << rows.all;
}

// A third of what can be left out is, whether it matters or not.
TEST(ModelPlanner, RandomWorldsTakeBackWhatMatters) {
  std::mt19937_64 engine(7);
  const PlannedRows rows = move_random_worlds(60, [&](const StepProblem& problem) {
    std::vector<RowPlan> plan = planned(problem);
    for (int row = 0; row < problem.row_count(); ++row)
      if (problem.row_kind[row] == RowKind::normal && engine() % 3 == 0) plan[row] = RowPlan::zero;
    return plan;
  });
  EXPECT_GT(rows.returned, rows.all / 20) << "of " << rows.all;
}

// Extraction builds no friction rows where mu = 0; problems of others may have them.
TEST(ModelPlanner, FrictionRowsWithoutBoundsAreLeftOut) {
  WorldStepper world = stepper_of(kScenes.at(2));
  world.steps(120);
  StepProblem problem = world.problem();
  int friction_rows = 0;
  for (int row = 0; row < problem.row_count(); ++row) {
    if (problem.row_kind[row] != RowKind::friction) continue;
    problem.lower[row] = problem.upper[row] = problem.warm_impulse[row] = 0;
    ++friction_rows;
  }
  ASSERT_GT(friction_rows, 0);
  const std::vector<RowPlan> plan = ModelPlanner().plan(problem);
  for (int row = 0; row < problem.row_count(); ++row)
    EXPECT_TRUE(problem.row_kind[row] != RowKind::friction || plan[row] != RowPlan::solved) << row;
  const Solved solved = solve_with(problem, ModelPlanner().plan(problem));
  expect_full_answer(problem, solved);
  EXPECT_GE(solved.counts.rows_left_out, friction_rows);
}

// A plan that leaves out rows in use: they come back, are counted, and the answer is the full one.
TEST(ModelPlanner, RowsWronglyLeftOutComeBack) {
  WorldStepper world = stepper_of(kScenes.at(2));
  world.steps(120);
  const StepProblem& problem = world.problem();
  const Solved full = solve_with(problem, std::vector<RowPlan>(problem.rhs.size(), RowPlan::solved));
  const auto loaded = [&](int row) {
    return problem.row_kind[row] == RowKind::normal && full.solution.impulse[row] > 1;
  };
  std::vector<RowPlan> plan = ModelPlanner().plan(problem);
  int row = 0;
  while (row < problem.row_count() && !loaded(row)) ++row;
  ASSERT_LT(row, problem.row_count());
  plan[row] = RowPlan::zero;
  const Solved solved = solve_with(problem, plan);
  expect_full_answer(problem, solved);
  EXPECT_GE(solved.counts.rows_returned, 1);
  EXPECT_GE(solved.counts.passes, 2);
  EXPECT_GT(solved.summary.factorizations, 0);
}

TEST(ModelPlanner, WithNothingLeftAllRowsComeBackInTheLastPass) {
  WorldStepper world = stepper_of(kScenes.at(2));
  world.steps(120);
  const StepProblem& problem = world.problem();
  const Solved solved = solve_with(problem, std::vector<RowPlan>(problem.rhs.size(), RowPlan::zero));
  expect_full_answer(problem, solved);
  EXPECT_EQ(solved.counts.rows_left_out, problem.row_count());
  EXPECT_LE(solved.counts.rows_returned, problem.row_count());
  EXPECT_LE(solved.counts.passes, kMostPasses);
}

TEST(ModelPlanner, WhatMovesIsTakenBackFromRest) {
  WorldStepper world = stepper_of(kScenes.at(2));
  world.steps(120);
  const StepProblem& problem = world.problem();
  const Solved solved = solve_with(problem, std::vector<RowPlan>(problem.rhs.size(), RowPlan::at_rest));
  expect_full_answer(problem, solved);
  EXPECT_EQ(solved.counts.rows_at_rest, problem.row_count());
  EXPECT_EQ(solved.counts.rows_left_out, 0);
  EXPECT_GT(solved.counts.rows_returned, 0);
}

// The answer of a step is its own rest: with its impulses as those of the step before all islands rest, and
// one body's push wakes the bodies that rows join to it and no others.
TEST(ModelPlanner, IslandsRestAndWakeApart) {
  WorldStepper world = stepper_of({{{"scene", "rock_pile"}, {"bodies", "30"}}, 0});
  world.steps(90);
  StepProblem problem = world.problem();
  problem.warm_impulse =
      solve_with(problem, std::vector<RowPlan>(problem.rhs.size(), RowPlan::solved)).solution.impulse;
  const std::vector<RowPlan> resting = ModelPlanner().plan(problem);
  EXPECT_EQ(std::ranges::count(resting, RowPlan::at_rest), problem.row_count());
  const Solved rest = solve_with(problem, resting);
  expect_full_answer(problem, rest);
  EXPECT_EQ(rest.counts.passes, 1);
  EXPECT_EQ(rest.solution.impulse, problem.warm_impulse);

  const int pushed = problem.row_body[0];
  problem.free_velocity[6 * pushed] += 0.5;
  std::vector<int> island(problem.body_count());
  count_islands(body_graph_of(problem), &island);
  const std::vector<RowPlan> woken = ModelPlanner().plan(problem);
  int moving = 0;
  for (int row = 0; row < problem.row_count(); ++row) {
    const bool moves = island[problem.row_body[2 * row]] == island[pushed];
    EXPECT_EQ(woken[row] == RowPlan::at_rest, !moves) << row;
    moving += moves;
  }
  EXPECT_LT(moving, problem.row_count());
  const Solved solved = solve_with(problem, woken);
  expect_full_answer(problem, solved);
  EXPECT_EQ(solved.counts.rows_at_rest, problem.row_count() - moving);
}

TEST(ModelPlanner, TurnedBoxesRest) {
  WorldStepper world = stepper_of({{{"scene", "rock_pile"}, {"bodies", "30"}}, 0});
  world.steps(90);
  StepProblem problem = world.problem();
  problem.box_angle_rad.assign(problem.rhs.size(), 0.0);
  for (int row = 0; row < problem.row_count(); ++row)
    if (problem.row_kind[row] == RowKind::normal) problem.box_angle_rad[row] = 0.6;
  problem.warm_impulse =
      solve_with(problem, std::vector<RowPlan>(problem.rhs.size(), RowPlan::solved)).solution.impulse;
  EXPECT_EQ(std::ranges::count(ModelPlanner().plan(problem), RowPlan::at_rest), problem.row_count());
}

// The answer of a pile at rest as impulses of the step before, with the sets that the friction model makes of
// its contacts.
StepProblem resting_pile(ContactSet set) {
  WorldStepper world = stepper_of({{{"scene", "rock_pile"}, {"bodies", "30"}}, 0});
  world.steps(90);
  StepProblem problem = world.problem();
  if (set != ContactSet::box) {
    EXPECT_EQ(turn_contacts(set, problem), "");
  }
  problem.warm_impulse =
      solve_with(problem, std::vector<RowPlan>(problem.rhs.size(), RowPlan::solved)).solution.impulse;
  return problem;
}

TEST(ModelPlanner, ConesRest) {
  for (const ContactSet set : {ContactSet::cone, ContactSet::coulomb}) {
    const StepProblem problem = resting_pile(set);
    const std::vector<RowPlan> plan = ModelPlanner().plan(problem);
    EXPECT_EQ(std::ranges::count(plan, RowPlan::at_rest), problem.row_count());
    expect_full_answer(problem, solve_with(problem, plan));
  }
}

// Whatever the solver, exact or not: with all at rest it is left nothing to do, on any number of threads.
TEST(ModelPlanner, EverySolverTakesAStepInWhichAllRests) {
  const StepProblem problem = resting_pile(ContactSet::box);
  std::vector<double> velocity = problem.free_velocity;
  rough_row_residuals(problem, problem.warm_impulse, {}, velocity);
  const std::vector<double> judged = judge(problem, problem.warm_impulse).velocity;
  for (std::size_t k = 0; k < velocity.size(); ++k) EXPECT_NEAR(velocity[k], judged[k], 1e-14);
  std::vector<std::string> names = all_solver_names();
  std::ranges::copy(chosen_kernel_solvers(), std::back_inserter(names));
  for (const std::string& name : names) {
    SolveOptions options;
    options.threads = 2;
    const std::unique_ptr<StepSolver> solver = make_solver(read_named("solver", name), options, {});
    Solution solution{problem.warm_impulse, problem.free_velocity};
    ModelCounts counts;
    const std::vector<int> part_of_body = one_part(problem);
    Parts parts(part_of_body);
    parts.kernel = "schur-rows";
    const SolveSummary summary = ModelPlanner().solve(*solver, problem, parts, solution, counts);
    if (name.ends_with(":chosen")) {
      EXPECT_EQ(summary.kernel, parts.kernel) << name;
    }
    EXPECT_EQ(summary.status, SolveStatus::ok) << name << ": " << summary.message;
    EXPECT_EQ(counts.rows_at_rest, problem.row_count()) << name;
    EXPECT_EQ(counts.passes, 1) << name;
    EXPECT_EQ(summary.factorizations, 0) << name;
    EXPECT_EQ(solution.impulse, problem.warm_impulse) << name;
    EXPECT_EQ(solution.velocity, velocity) << name;
  }
}

// One solver through steps in which first one island moves, then none, then all: what it carries from a step
// to the next fits no bodies as well as all of them.
TEST(ModelPlanner, ASolverGoesFromRestToMotionAndBack) {
  const StepProblem resting = resting_pile(ContactSet::box);
  StepProblem pushed = resting, moving = resting;
  pushed.free_velocity[6 * resting.row_body[0]] += 0.5;
  moving.warm_impulse.assign(resting.rhs.size(), 0.0);
  SolveOptions options;
  options.session = true;
  const std::unique_ptr<StepSolver> solver = make_step_solver("exact", options);
  ModelPlanner planner;
  const StepProblem* const steps[] = {&pushed, &resting, &moving, &resting, &resting, &pushed};
  for (const StepProblem* problem : steps) {
    Solved solved{{problem->warm_impulse, problem->free_velocity}, {}, {}};
    solved.summary = planner.solve(*solver, *problem, one_part(*problem), solved.solution, solved.counts);
    expect_full_answer(*problem, solved);
    EXPECT_EQ(solved.counts.rows_at_rest == problem->row_count(), problem == &resting);
  }
}

// A contact that parts faster than anything can push is left out; one that parts slowly beside a violated row
// stays.
TEST(ModelPlanner, MarginIsWhatOtherRowsAreViolatedBy) {
  StepProblem problem;
  problem.h_s = 0.01;
  problem.mass.assign(36, 0.0);
  for (int k = 0; k < 6; ++k) problem.mass[7 * k] = 1;
  problem.free_velocity = {0, 0, -1, 0, 0, 0};
  problem.row_body = {0, -1, 0, -1};
  problem.jacobian.assign(24, 0.0);
  problem.jacobian[2] = 1;        // falls onto the floor at 1 m/s
  problem.jacobian[12 + 2] = -1;  // parts from the ceiling at 1 m/s and its gap
  problem.compliance = {1e-3, 1e-3};
  problem.lower = {0, 0};
  problem.upper.assign(2, std::numeric_limits<double>::infinity());
  problem.row_kind.assign(2, RowKind::normal);
  problem.friction_row = {-1, -1};
  problem.friction_coefficient = {0, 0};
  problem.row_constraint = {0, 1};
  problem.contact_point.assign(6, 0.0);
  problem.warm_impulse = {0, 0};
  for (const auto& [gap_m_per_s, is_left_out] : {std::pair{0.5, true}, {-0.5, false}}) {
    problem.rhs = {0, -gap_m_per_s};
    ASSERT_EQ(find_problem_error(problem), "");
    EXPECT_EQ(ModelPlanner().plan(problem),
              (std::vector<RowPlan>{RowPlan::solved, is_left_out ? RowPlan::zero : RowPlan::solved}));
    expect_full_answer(problem, solve_with(problem, ModelPlanner().plan(problem)));
  }
  problem.warm_impulse = {0, 1};
  EXPECT_EQ(ModelPlanner().plan(problem), std::vector<RowPlan>(2, RowPlan::solved))
      << "it was loaded in the step before";
}

}  // namespace
}  // namespace cleave
