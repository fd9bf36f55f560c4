// ODE's own solvers as baselines: the rebuilt world poses the same problem, row for row, and its forces come
// back as the impulses of the right rows with the right signs.
#include "harness/world/ode_baselines.h"
#include "harness/experiment/algorithms.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "harness/experiment/friction_box.h"
#include "harness/world/contact_memory.h"
#include "harness/world/extract.h"
#include "scenarios/scene_random.h"
#include "solver/residual.h"
#include "tests/harness/dense_oracle.h"
#include "tests/harness/ode_test_world.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

constexpr double kStep_s = 1.0 / 60;

struct Solved {
  SolveSummary summary;
  Solution solution;
  ResidualReport verdict;
  int messages = 0;
};

struct Step {
  OdeWorld& world;
  std::vector<ContactPoint> contacts;
  ExtractOptions options;
  StepProblem problem;
};

Step take_step(OdeWorld& world, const ExtractOptions& options,
               const ContactMemory& memory = ContactMemory()) {
  Step step{world, world.collide(8, nullptr), options, {}};
  step.problem = extract(world, step.contacts, options, memory);
  if (options.friction == FrictionModel::box) predict_friction_bounds(step.problem);
  world.take_message_count();
  return step;
}

// text: as for --solver, with parameters.
Solved solve_with_ode(const std::string& text, const Step& step) {
  const StepContext context{&step.world, step.contacts, step.options.erp, step.options.cfm};
  const std::unique_ptr<StepSolver> baseline = make_ode_baseline(read_named("solver", text), context);
  Solved solved;
  solved.solution.impulse = step.problem.warm_impulse;
  solved.summary = baseline->solve(step.problem, {}, solved.solution);
  solved.messages = solved.summary.engine_messages;
  solved.verdict = judge(step.problem, solved.solution.impulse);
  return solved;
}

double largest_gap(std::span<const double> a, std::span<const double> b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(std::abs(a[i] - b[i]) <= largest)) largest = std::abs(a[i] - b[i]);
  return largest;
}

struct Exact {
  std::vector<double> impulse, velocity;
};

Exact solve_by_oracle(const StepProblem& problem) {
  const OracleSolution oracle = solve_exactly(problem);
  EXPECT_LE(oracle.residual, 1e-11) << "oracle, rows " << problem.row_count();
  return {{oracle.impulse.begin(), oracle.impulse.end()}, {oracle.velocity.begin(), oracle.velocity.end()}};
}

// Moves the world by the exact solution of its present step.
void advance(OdeWorld& world, const Step& step, const Exact& exact, ContactMemory& memory) {
  world.advance(exact.velocity, kStep_s);
  memory.remember(step.contacts, step.problem, exact.impulse);
}

// Eight boxes that fall, land and slide in a narrow pit.
std::unique_ptr<OdeWorld> make_pile(std::uint64_t seed) {
  return make_world([seed](SceneBuilder& builder) {
    SceneRandom random(seed);
    for (int i = 0; i < 8; ++i) {
      const auto edge = [&] { return random.uniform(0.5, 0.8); };
      const auto jitter = [&] { return random.uniform(-0.1, 0.1); };
      const Pose pose{{(i % 2) - 0.5 + jitter(), jitter(), 0.5 + i / 2 + jitter()},
                      {1, jitter(), jitter(), jitter()}};
      builder.add_box(pose, random.uniform(1, 100), {edge(), edge(), edge()});
    }
    builder.add_square_pit(1.1);
  });
}

// A free body of random mass, inertia, place, orientation and velocity.
void add_random_body(dWorldID world, SceneContent& content, SceneRandom& random) {
  const dBodyID body = dBodyCreate(world);
  dMass mass;
  dMassSetBoxTotal(&mass, random.uniform(0.5, 20), random.uniform(0.2, 1), random.uniform(0.2, 1),
                   random.uniform(0.2, 1));
  dBodySetMass(body, &mass);
  const auto entry = [&random](double size) { return random.uniform(-size, size); };
  dBodySetPosition(body, entry(1), entry(1), entry(1));
  dBodySetQuaternion(body, random.rotation().data());
  dBodySetLinearVel(body, entry(3), entry(3), entry(3));
  dBodySetAngularVel(body, entry(5), entry(5), entry(5));
  content.bodies.push_back(body);
}

using AddJoint = std::function<dJointID(dWorldID, dBodyID, dBodyID)>;

struct JointCase {
  const char* name;
  AddJoint add;
};

const JointCase kJoints[] = {
    {"ball",
     [](dWorldID world, dBodyID a, dBodyID b) {
       const dJointID joint = dJointCreateBall(world, nullptr);
       dJointAttach(joint, a, b);
       dJointSetBallAnchor(joint, 0.1, 0.2, 0.3);
       return joint;
     }},
    {"hinge",
     [](dWorldID world, dBodyID a, dBodyID b) {
       const dJointID joint = dJointCreateHinge(world, nullptr);
       dJointAttach(joint, a, b);
       dJointSetHingeAnchor(joint, 0.1, 0.2, 0.3);
       dJointSetHingeAxis(joint, 1, 2, 3);
       return joint;
     }},
    {"slider",
     [](dWorldID world, dBodyID a, dBodyID b) {
       const dJointID joint = dJointCreateSlider(world, nullptr);
       dJointAttach(joint, a, b);
       dJointSetSliderAxis(joint, 2, -1, 1);
       return joint;
     }},
    {"fixed",
     [](dWorldID world, dBodyID a, dBodyID b) {
       const dJointID joint = dJointCreateFixed(world, nullptr);
       dJointAttach(joint, a, b);
       dJointSetFixed(joint);
       return joint;
     }},
};

// Three bodies: a joint between the first two, one that holds the third to the world, attached as (body,
// world) or (world, body). Then everything is moved out of place, so that every row has an error to remove.
std::unique_ptr<OdeWorld> make_joined(const JointCase& joint, bool world_first, std::uint64_t seed) {
  auto world = make_world(
      [joint, world_first, seed](dWorldID w, dSpaceID, SceneContent& content) {
        SceneRandom random(seed);
        for (int i = 0; i < 3; ++i) add_random_body(w, content, random);
        const auto& bodies = content.bodies;
        content.joints.push_back(joint.add(w, bodies[0], bodies[1]));
        content.joints.push_back(
            joint.add(w, world_first ? nullptr : bodies[2], world_first ? bodies[2] : nullptr));
        content.joints.push_back(kJoints[0].add(w, bodies[1], bodies[2]));
      },
      9.81);
  SceneRandom random(seed + 1000);
  for (int i = 0; i < world->body_count(); ++i) {
    BodyState state = world->state(i);
    for (double& x : state.position_m) x += random.uniform(-0.05, 0.05);
    for (double& q : state.orientation) q += random.uniform(-0.05, 0.05);
    world->set_state(i, state);
  }
  return world;
}

TEST(OdeStep, AgreesWithTheOracleOnAPileThatFalls) {
  for (const FrictionModel friction : {FrictionModel::box, FrictionModel::none, FrictionModel::constant}) {
    const auto world = make_pile(3);
    const ExtractOptions options{kStep_s, 0.2, 1e-5, friction, 0.5, 30};
    ContactMemory memory;
    int most_rows = 0, silent_steps = 0;
    for (int i = 0; i < 60; ++i) {
      const Step step = take_step(*world, options, memory);
      const Exact exact = solve_by_oracle(step.problem);
      const Solved solved = solve_with_ode("ode-step", step);
      ASSERT_EQ(solved.summary.status, SolveStatus::ok) << solved.summary.message;
      most_rows = std::max(most_rows, step.problem.row_count());
      if (solved.messages == 0) {
        ++silent_steps;
        EXPECT_LE(solved.verdict.residual_m_per_s, 1e-9) << "step " << i;
        EXPECT_LE(largest_gap(solved.solution.velocity, exact.velocity), 1e-9) << "step " << i;
        EXPECT_LE(largest_gap(solved.solution.impulse, exact.impulse), 1e-5) << "step " << i;
      }
      advance(*world, step, exact, memory);
    }
    EXPECT_GT(silent_steps, 50);
    EXPECT_GT(most_rows, friction == FrictionModel::none ? 20 : 60) << "the boxes must have landed";
  }
}

TEST(OdeStep, ReadsTheRowsOfEveryJointKindWithTheirSigns) {
  for (const JointCase& joint : kJoints)
    for (const bool world_first : {false, true})
      for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const auto world = make_joined(joint, world_first, seed);
        const Step step = take_step(*world, {kStep_s, 0.3, 1e-4});
        ASSERT_GT(step.problem.row_count(), 8);
        const std::vector<double> impulse = solve_by_oracle(step.problem).impulse;
        double size = 0, least = 1e9;
        for (const double value : impulse) {
          size = std::max(size, std::abs(value));
          least = std::min(least, std::abs(value));
        }
        ASSERT_GT(least, 1e-9 * size) << "a row that proves nothing";
        const std::string which =
            std::string(joint.name) + (world_first ? " world first" : "") + " seed " + std::to_string(seed);
        const Solved solved = solve_with_ode("ode-step", step);
        EXPECT_LE(solved.verdict.residual_m_per_s, 1e-9) << which;
        EXPECT_LE(largest_gap(solved.solution.impulse, impulse), 1e-9 * size) << which;
        const Solved quick = solve_with_ode("ode-quickstep@quickstep-iterations=20000", step);
        EXPECT_LE(quick.verdict.residual_m_per_s, 1e-9) << which;
        EXPECT_LE(largest_gap(quick.solution.impulse, impulse), 1e-8 * size) << which;
      }
}

TEST(OdeQuickStep, ComesCloserWithEveryTenfoldOfIterations) {
  const auto world = make_pile(5);
  const ExtractOptions options{kStep_s, 0.2, 1e-5, FrictionModel::box, 0.5};
  ContactMemory memory;
  for (int i = 0; i < 45; ++i) {
    const Step step = take_step(*world, options, memory);
    advance(*world, step, solve_by_oracle(step.problem), memory);
  }
  const Step step = take_step(*world, options, memory);
  ASSERT_GT(step.problem.row_count(), 60);
  double last = 1e9;
  for (const int iterations : {2, 20, 200, 2000, 20000}) {
    const Solved solved =
        solve_with_ode("ode-quickstep@quickstep-iterations=" + std::to_string(iterations), step);
    EXPECT_EQ(solved.summary.iterations, iterations);
    EXPECT_TRUE(solved.verdict.residual_m_per_s < last / 2 || solved.verdict.exact)
        << iterations << " iterations: " << solved.verdict.residual_m_per_s << " after " << last;
    last = solved.verdict.residual_m_per_s;
  }
  EXPECT_LE(last, 1e-6);
}

TEST(OdeBaselines, LeaveTheWorldAloneAndRepeatThemselves) {
  const auto world = make_pile(7);
  for (int i = 0; i < 30; ++i) {
    const Step step = take_step(*world, {});
    world->advance(judge(step.problem, solve_with_ode("ode-step", step).solution.impulse).velocity, kStep_s);
  }
  const Step step = take_step(*world, {});
  ASSERT_GT(step.problem.row_count(), 20);
  const std::uint64_t before = world->state_hash();
  for (const char* name : {"ode-step", "ode-quickstep"}) {
    const Solved first = solve_with_ode(name, step), second = solve_with_ode(name, step);
    EXPECT_EQ(first.solution.impulse, second.solution.impulse) << name;
    EXPECT_EQ(world->state_hash(), before) << name;
    EXPECT_EQ(extract(*world, step.contacts, step.options, ContactMemory()).rhs, step.problem.rhs) << name;
  }
}

TEST(OdeBaselines, ForcesAndModesOfTheBodiesAreCopied) {
  const auto world = make_world(
      [](dWorldID w, dSpaceID, SceneContent& content) {
        SceneRandom random(1);
        for (int i = 0; i < 3; ++i) add_random_body(w, content, random);
        content.joints.push_back(kJoints[0].add(w, content.bodies[0], content.bodies[1]));
        content.joints.push_back(kJoints[0].add(w, content.bodies[1], content.bodies[2]));
      },
      9.81);
  const auto& bodies = world->content().bodies;
  dBodyAddForce(bodies[0], 1, 2, 3);
  dBodyAddTorque(bodies[1], 3, -2, 1);
  dBodySetGravityMode(bodies[1], 0);
  dBodySetGyroscopicMode(bodies[2], 0);
  dJointDisable(world->content().joints[1]);
  const Step step = take_step(*world, {});
  EXPECT_EQ(step.problem.row_count(), 3);
  const Solved solved = solve_with_ode("ode-step", step);
  EXPECT_LE(solved.verdict.residual_m_per_s, 1e-11);
  EXPECT_LE(largest_gap(solved.solution.velocity, solved.verdict.velocity), 1e-11);
}

// The problem's bounds are set to nothing, so that what ODE finds by itself is seen. Both tangents of this
// plane follow its slope or its level.
TEST(OdeBaselines, FrictionIsTheProblemsOrOdesOwn) {
  const auto world = make_world("ladder_incline", {{"angle", "15"}}, 1);
  Step step = take_step(*world, {.mu = 0.2});
  for (int r = 0; r < step.problem.row_count(); ++r)
    if (step.problem.row_kind[r] == RowKind::friction) step.problem.lower[r] = step.problem.upper[r] = 0;
  const double angle_rad = std::acos(-1.0) / 12;
  const auto speed = [&](const std::string& solver, const std::string& friction) {
    const std::vector<double> v =
        solve_with_ode(solver + "@ode-friction=" + friction, step).solution.velocity;
    return v[0] * std::cos(angle_rad) - v[2] * std::sin(angle_rad);
  };
  const double pull = 9.81 * std::sin(angle_rad), hold = 0.2 * 9.81 * std::cos(angle_rad);
  for (const char* solver : {"ode-step", "ode-quickstep@quickstep-iterations=3000"}) {
    EXPECT_NEAR(speed(solver, "limits"), pull * kStep_s, 1e-4) << solver;
    EXPECT_NEAR(speed(solver, "pyramid"), (pull - hold) * kStep_s, 1e-4) << solver;
  }
}

TEST(OdeBaselines, RefuseWithAReason) {
  const auto world = make_joined(kJoints[1], false, 1);
  const Step step = take_step(*world, {});
  const int rows = step.problem.row_count();
  EXPECT_EQ(solve_with_ode("ode-step@ode-step-max-rows=" + std::to_string(rows), step).summary.status,
            SolveStatus::ok);
  const Solved refused = solve_with_ode("ode-step@ode-step-max-rows=" + std::to_string(rows - 1), step);
  EXPECT_EQ(refused.summary.status, SolveStatus::refused);
  EXPECT_NE(refused.summary.message.find(std::to_string(rows) + " rows"), std::string::npos);
  EXPECT_NE(refused.summary.message.find("ode-step-max-rows"), std::string::npos);
  Solution solution;
  const StepContext nothing;
  const SolveSummary blind =
      make_ode_baseline(read_named("solver", "ode-quickstep"), nothing)->solve(step.problem, {}, solution);
  EXPECT_EQ(blind.status, SolveStatus::refused);
  EXPECT_EQ(make_ode_baseline(read_named("solver", "exact"), nothing), nullptr);
}

// Rigid contact of a box with copies of its shape: redundant rows without compliance.
TEST(OdeBaselines, MessagesOfTheSolveAreCountedOnceAndThere) {
  const auto world = make_world("ladder_stack", {{"boxes", "3"}, {"copies", "2"}}, 1);
  const Step step = take_step(*world, {kStep_s, 0.2, 0});
  const Solved solved = solve_with_ode("ode-step", step);
  EXPECT_GT(solved.messages, 0);
  EXPECT_NE(solved.summary.message.find("s <= 0"), std::string::npos) << solved.summary.message;
  EXPECT_EQ(world->take_message_count(), 0);
}

TEST(OdeBaselines, NoRowsIsFreeFall) {
  const auto world = make_world("ladder_free", {{"boxes", "2"}}, 1);
  const Step step = take_step(*world, {});
  ASSERT_EQ(step.problem.row_count(), 0);
  for (const char* name : {"ode-step", "ode-quickstep"})
    EXPECT_EQ(largest_gap(solve_with_ode(name, step).solution.velocity, step.problem.free_velocity), 0)
        << name;
}

TEST(OdeBaselines, AreOrdinarySolversOfARun) {
  const TemporaryDirectory directory;
  const std::string solvers = "exact,ode-step,ode-quickstep";
  const ProgramResult result =
      run_cleave({"run", "--scene", "ladder_stack", "--boxes", "3", "--steps", "20", "--solver", solvers,
                  "--partitioner", "mindp", "--refiner", "none", "--quickstep-iterations", "3000",
                  "--ode-step-max-rows", "36", "--out", directory / "out"});
  const CsvTable table = read_csv(directory / "out/steps.csv");
  ASSERT_EQ(table.rows.size(), 60u) << result.err;
  int silent_rows = 0;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const std::string& solver = table.at(r, "solver");
    const double residual = std::stod(table.at(r, "residual_m_per_s"));
    if (solver == "ode-quickstep") {
      EXPECT_LE(residual, 1e-3);
      EXPECT_LE(std::stod(table.at(r, "velocity_spread_m_per_s")), 1e-3);
    } else if (table.at(r, "ode_messages") == "0") {
      ++silent_rows;
      EXPECT_EQ(table.at(r, "status"), "ok") << solver << ", step " << table.at(r, "step");
      EXPECT_LE(std::stod(table.at(r, "velocity_spread_m_per_s")), 1e-9);
    } else {
      // The first step, where everything is in balance, is one of those on which dWorldStep gives up.
      EXPECT_EQ(solver, "ode-step");
      EXPECT_GT(residual, 1e-9);
      EXPECT_NE(table.at(r, "status_reason").find("s <= 0"), std::string::npos);
    }
  }
  EXPECT_GE(silent_rows, 36);
}

// The bounds of a step are then found by solving it, with its own contacts.
TEST(OdeBaselines, MayConvergeTheBoundsOfAStep) {
  for (const std::string solver : {"ode-step", "ode-quickstep@quickstep-iterations=3000"}) {
    const TemporaryDirectory directory;
    const ProgramResult result =
        run_cleave({"run", "--scene", "ladder_incline", "--mu", "0.2", "--steps", "20", "--solver", solver,
                    "--advance", solver, "--friction", "box-converged", "--out", directory / "out"});
    const CsvTable table = read_csv(directory / "out/steps.csv");
    ASSERT_EQ(table.rows.size(), 20u) << solver << ": " << result.err;
    for (std::size_t r = 0; r < table.rows.size(); ++r)
      EXPECT_LE(std::stod(table.at(r, "residual_m_per_s")), solver == "ode-step" ? 1e-9 : 1e-4)
          << solver << ", step " << r;
    EXPECT_EQ(result.exit_code, solver == "ode-step" ? 0 : 2) << result.err;
    EXPECT_LE(std::stod(table.at(19, "bound_mismatch")), 1e-5) << solver;
  }
}

TEST(OdeBaselines, ARefusedWorldLeavesRowsWithTheReason) {
  const TemporaryDirectory directory;
  const ProgramResult result =
      run_cleave({"run", "--scene", "ladder_stack", "--boxes", "3", "--steps", "4", "--solver", "ode-step",
                  "--advance", "ode-step", "--ode-step-max-rows", "35", "--out", directory / "out"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("36 rows, more than --ode-step-max-rows 35"), std::string::npos) << result.err;
  const CsvTable table = read_csv(directory / "out/steps.csv");
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(table.at(0, "status"), "refused");
  EXPECT_EQ(table.at(0, "status_reason"), "36 rows, more than --ode-step-max-rows 35");
  for (const char* column : {"residual_m_per_s", "t_s_ms", "t_s_min_ms", "t_s_max_ms", "t_s_cpu_ms",
                             "t_s_waiting_ms", "t_s_other_ms", "factor_mflop_local"})
    EXPECT_EQ(table.at(0, column), "nan") << column;
  for (const char* column : {"iterations", "factorizations", "fallbacks", "refinements"})
    EXPECT_EQ(table.at(0, column), "-1") << column;
  EXPECT_EQ(table.at(0, "solution_hash"), "-");
  EXPECT_EQ(table.at(1, "status"), "skipped");
  EXPECT_NE(table.at(1, "status_reason").find("stopped at step 0: refused, 36 rows"), std::string::npos);
}

TEST(OdeBaselines, AreRefusedWhereThereIsNoWorldAndNamedWhenMisspelt) {
  const TemporaryDirectory directory;
  const ProgramResult recorded = run_cleave(
      {"record", "--scene", "ladder_stack", "--boxes", "2", "--at", "1", "--out", directory / "record"});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  for (const char* name : {"ode-step", "ode-quickstep"}) {
    const ProgramResult replayed =
        run_cleave({"replay", directory / "record/ladder_stack_step000001.h5", "--solver",
                    "exact," + std::string(name), "--out", directory / "replay"});
    EXPECT_EQ(replayed.exit_code, 1);
    EXPECT_NE(replayed.err.find(std::string("--solver: ") + name), std::string::npos) << replayed.err;
    EXPECT_EQ(std::ranges::count(replayed.err, '\n'), 1) << replayed.err;
    EXPECT_FALSE(std::filesystem::exists(directory / "replay"));
  }
  const ProgramResult misspelt =
      run_cleave({"run", "--scene", "ladder_stack", "--solver", "ode-quikstep", "--out", directory / "out"});
  EXPECT_EQ(misspelt.exit_code, 1);
  EXPECT_NE(misspelt.err.find("'ode-quickstep'"), std::string::npos) << misspelt.err;
}

}  // namespace
}  // namespace cleave
