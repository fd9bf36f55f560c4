// The contract of step_solver.h, checked for every name the registry knows. Solvers in may_miss() may end
// without a solution but must say so; all others must be exact everywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "solver/registry.h"
#include "solver/step_solver.h"
#include "tests/solver/enumeration_oracle.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

constexpr int kSeeds = 300;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class SolverContractTest : public testing::TestWithParam<std::string> {
 protected:
  // With a value for a parameter, where the solver has it; with sweeps enough to solve some of the small
  // problems.
  static std::unique_ptr<StepSolver> make(const SolveOptions& options = {}, const std::string& parameter = "",
                                          const std::string& value = "") {
    const std::string sweeps = has("sweeps") ? "@sweeps=50" : "";
    const std::string own = has(parameter) ? "@" + parameter + "=" + value : "";
    return make_step_solver(GetParam() + sweeps + own, options);
  }

  static bool has(const std::string& parameter) {
    return std::ranges::count(solver_parameters(GetParam()), parameter, &Parameter::name) > 0;
  }

  static SolveSummary solve(const StepProblem& problem, std::span<const int> parts, Solution& solution,
                            const SolveOptions& options = {}) {
    return make(options)->solve(problem, parts, solution);
  }

  // Exact, or for solvers that may miss: honest. True where there is a solution to compare.
  static bool expect_solved(const StepProblem& problem, const SolveSummary& summary,
                            const Solution& solution) {
    if (!may_miss(GetParam())) {
      EXPECT_TRUE(is_exact(problem, summary, solution));
    } else {
      EXPECT_TRUE(is_honest(problem, summary, solution));
    }
    return summary.status == SolveStatus::ok;
  }

  // How many of the cases must have had a solution to compare: all, and some of a solver that may miss.
  static int least_compared(int cases) { return may_miss(GetParam()) ? (cases + 4) / 5 : cases; }

  static void expect_oracle(const SmallProblemOptions& options, std::uint64_t first_seed, int seeds,
                            double tolerance) {
    const auto solver = make();
    for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const StepProblem problem = make_small_problem(seed, options);
      SeededRandom random(seed);
      const int bodies = problem.body_count();
      const std::vector<int> parts = random_parts(random, bodies, random.integer(1, bodies));
      Solution solution = cold_start(problem);
      const SolveSummary summary = solver->solve(problem, parts, solution);
      if (expect_solved(problem, summary, solution)) {
        const OracleSolution oracle = solve_by_enumeration(problem);
        EXPECT_TRUE(velocities_agree(problem, solution.velocity, oracle.velocity, tolerance));
      }
    }
  }
};

TEST_P(SolverContractTest, SmallProblemsMatchTheOracle) { expect_oracle({}, 0, kSeeds, 1e-9); }

TEST_P(SolverContractTest, FeasibleSmallProblemsMatchTheOracle) {
  expect_oracle({.least_cfm = 1e-8, .most_cfm = 1e-5, .feasible = true}, 1000, kSeeds, 1e-9);
}

// A residual e bounds the velocity error by e / sqrt(C) only, so the velocities are compared less closely
// here.
TEST_P(SolverContractTest, StiffSmallProblemsMatchTheOracle) {
  expect_oracle({.least_cfm = 1e-14, .most_cfm = 1e-8, .feasible = true}, 2000, kSeeds, 1e-7);
}

TEST_P(SolverContractTest, WithoutComplianceOkStillMeansExact) {
  const auto solver = make();
  for (int seed = 3000; seed < 3100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    StepProblem problem = make_small_problem(seed, {.feasible = true});
    std::fill(problem.compliance.begin(), problem.compliance.end(), 0.0);
    Solution solution = cold_start(problem);
    const SolveSummary summary = solver->solve(problem, own_parts(problem.body_count()), solution);
    EXPECT_TRUE(is_honest(problem, summary, solution));
  }
}

TEST_P(SolverContractTest, ExactStepsGainNoEnergy) {
  const auto solver = make();
  int compared = 0;
  for (int seed = 4000; seed < 4200; ++seed) {
    const StepProblem problem = make_small_problem(seed, {.zero_inside_bounds = true});
    Solution solution = cold_start(problem);
    if (solver->solve(problem, own_parts(problem.body_count()), solution).status != SolveStatus::ok) continue;
    ++compared;
    const ResidualReport report = judge(problem, solution.impulse);
    EXPECT_LE(report.energy_excess_j, 1e-9 * std::max(1.0, report.kinetic_energy_j)) << "seed " << seed;
  }
  EXPECT_GE(compared, least_compared(200));
}

TEST_P(SolverContractTest, AnyWarmStartGivesTheSameSolution) {
  const auto solver = make();
  int compared = 0;
  for (int seed = 5000; seed < 5100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const StepProblem problem = make_small_problem(seed, {.least_cfm = 1e-5});
    const std::vector<int> parts = own_parts(problem.body_count());
    Solution cold = cold_start(problem);
    if (!expect_solved(problem, solver->solve(problem, parts, cold), cold)) continue;

    Solution again = cold;
    if (expect_solved(problem, solver->solve(problem, parts, again), again)) {
      EXPECT_TRUE(velocities_agree(problem, again.velocity, cold.velocity, 1e-9));
    }
    SeededRandom random(seed);
    Solution wild = cold;
    for (double& impulse : wild.impulse) impulse = random.uniform(-1e4, 1e4);  // mostly outside the bounds
    if (expect_solved(problem, solver->solve(problem, parts, wild), wild)) {
      EXPECT_TRUE(velocities_agree(problem, wild.velocity, cold.velocity, 1e-9));
      ++compared;
    }
  }
  EXPECT_GE(compared, least_compared(100));
}

TEST_P(SolverContractTest, ThePartitionDoesNotChangeTheSolution) {
  int compared = 0;
  for (int seed = 0; seed < 2; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const StepProblem problem = make_pile(seed, {.columns = 2, .rows = 2, .layers = 2, .mass_ratio = 10});
    const int bodies = problem.body_count();
    SeededRandom random(seed);
    Solution whole = cold_start(problem);
    if (!expect_solved(problem, solve(problem, single_part(bodies), whole), whole)) continue;
    for (const std::vector<int>& parts : {own_parts(bodies), sliced_parts(bodies, 3), sliced_parts(bodies, 2),
                                          random_parts(random, bodies, 4)}) {
      Solution split = cold_start(problem);
      if (!expect_solved(problem, solve(problem, parts, split), split)) continue;
      EXPECT_TRUE(velocities_agree(problem, split.velocity, whole.velocity, 1e-9));
      ++compared;
    }
  }
  // Those that may miss end without a solution on every one of these piles, and say so.
  if (!may_miss(GetParam())) {
    EXPECT_EQ(compared, 2 * 4);
  }
}

// Interface of schur-rows: the rows at the cut. Of schur-bodies: a vertex cover of the cut pairs, six
// unknowns a body.
TEST_P(SolverContractTest, InterfaceHasTheSizeOfTheCut) {
  const StepProblem problem = make_pile(7, {.columns = 2, .rows = 2, .layers = 2});
  const int bodies = problem.body_count();
  SeededRandom random(7);
  for (const std::vector<int>& parts :
       {single_part(bodies), own_parts(bodies), sliced_parts(bodies, 3), random_parts(random, bodies, 4)}) {
    Solution solution = cold_start(problem);
    const int unknowns = solve(problem, parts, solution).interface_unknowns;
    const int cut_rows = count_cut_rows(problem, parts);
    if (kernel_of(GetParam()) == "schur-rows") {
      EXPECT_EQ(unknowns, cut_rows);
    } else if (kernel_of(GetParam()) == "schur-bodies") {
      std::vector<char> matched(bodies, 0);  // every cover has a body of each pair of any matching
      int pairs = 0;
      for (int r = 0; r < problem.row_count(); ++r) {
        const int a = problem.row_body[2 * r], b = problem.row_body[2 * r + 1];
        if (b < 0 || parts[a] == parts[b] || matched[a] || matched[b]) continue;
        matched[a] = matched[b] = 1;
        ++pairs;
      }
      EXPECT_EQ(unknowns % 6, 0);
      EXPECT_GE(unknowns, 6 * pairs);
      EXPECT_LE(unknowns, std::min(6 * bodies, 6 * cut_rows));
    } else if (!make()->uses_partition()) {
      EXPECT_EQ(unknowns, 0);
    }
  }
}

TEST_P(SolverContractTest, TwoThreadsGiveTheBytesOfOne) {
  for (const StepProblem& problem : {make_pile(11, {.columns = 3, .rows = 2, .layers = 2, .mu = 0}),
                                     make_chain(11, {.links = 30, .extra_joints = 6, .closed = true})}) {
    const std::vector<int> parts = sliced_parts(problem.body_count(), 5);
    Solution one = cold_start(problem), two = cold_start(problem);
    const SolveSummary first = solve(problem, parts, one, {.threads = 1});
    const SolveSummary second = solve(problem, parts, two, {.threads = 2});
    expect_solved(problem, first, one);
    EXPECT_TRUE(same_bytes(one.impulse, two.impulse));
    EXPECT_TRUE(same_bytes(one.velocity, two.velocity));
    EXPECT_EQ(first.iterations, second.iterations);
    EXPECT_EQ(first.factorizations, second.factorizations);
  }
}

TEST_P(SolverContractTest, EarlierProblemsLeaveNoTrace) {
  for (const bool reuse_analysis : {false, true}) {
    const auto make_one = [&] { return make({}, "reuse-analysis", reuse_analysis ? "true" : "false"); };
    const auto used = make_one();
    for (int seed = 6000; seed < 6060; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const StepProblem problem = make_small_problem(seed);
      SeededRandom random(seed);
      const std::vector<int> parts =
          random_parts(random, problem.body_count(), random.integer(1, problem.body_count()));
      for (int repeat = 0; repeat < 2; ++repeat) {
        Solution from_used = cold_start(problem), from_fresh = cold_start(problem);
        const SolveSummary summary = used->solve(problem, parts, from_used);
        make_one()->solve(problem, parts, from_fresh);
        expect_solved(problem, summary, from_used);
        // A kept elimination order rounds otherwise; without one every byte must be the same.
        EXPECT_TRUE(reuse_analysis || same_bytes(from_used.impulse, from_fresh.impulse));
        EXPECT_TRUE(velocities_agree(problem, from_used.velocity, from_fresh.velocity, 1e-8));
      }
    }
  }
}

TEST_P(SolverContractTest, NothingToSolve) {
  const auto solver = make();
  StepProblem problem;
  problem.h_s = kTestStep_s;
  for (int bodies = 0; bodies <= 3; ++bodies) {  // no body, then bodies in free fall
    for (const bool split : {false, true}) {
      Solution solution;
      const SolveSummary summary =
          solver->solve(problem, split ? own_parts(bodies) : single_part(bodies), solution);
      EXPECT_TRUE(is_exact(problem, summary, solution)) << bodies << " bodies";
      EXPECT_EQ(solution.velocity, problem.free_velocity);
      EXPECT_EQ(summary.interface_unknowns, 0);
    }
    append_body(problem, 1, {1, 2, 3}, {1, 2, 3, 4, 5, 6});
  }
}

TEST_P(SolverContractTest, OneBodyOnOneRow) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 2, {1, 1, 1}, {0.25, 0, -1, 0, 0, 0});
  RowSpec floor;
  floor.jacobian_a = {0, 0, 1, 0, 0, 0};
  floor.compliance = 0.5;
  floor.lower = 0;
  floor.kind = RowKind::normal;
  append_row(problem, floor);
  Solution solution = cold_start(problem);
  if (expect_solved(problem, solve(problem, single_part(1), solution), solution)) {
    EXPECT_NEAR(solution.impulse[0], 1, 1e-9);
    EXPECT_NEAR(solution.velocity[2], -0.5, 1e-9);
    EXPECT_EQ(solution.velocity[0], 0.25);
  }
}

TEST_P(SolverContractTest, NanInTheProblemIsAStatus) {
  for (int seed = 0; seed < 20; ++seed) {
    for (const auto array :
         {&StepProblem::mass, &StepProblem::free_velocity, &StepProblem::jacobian, &StepProblem::rhs,
          &StepProblem::compliance, &StepProblem::lower, &StepProblem::upper}) {
      StepProblem problem = make_small_problem(seed);
      (problem.*array)[0] = kNan;
      Solution solution = cold_start(problem);
      SolveSummary summary;
      ASSERT_NO_THROW(summary = solve(problem, own_parts(problem.body_count()), solution)) << "seed " << seed;
      EXPECT_NE(summary.status, SolveStatus::ok) << "seed " << seed;
      EXPECT_FALSE(summary.message.empty()) << "seed " << seed;
    }
  }
}

TEST_P(SolverContractTest, StageTimesAddUp) {
  const StepProblem problem = make_pile(13, {.columns = 3, .rows = 2, .layers = 3, .mu = 0});
  SolveOptions options;
  options.models_workers = true;
  Solution solution = cold_start(problem);
  const SolveSummary summary = solve(problem, sliced_parts(problem.body_count(), 4), solution, options);
  const StageTimes& times = summary.times;
  double named_ms = 0;
  for (const double stage_ms : times.stage_ms) {
    EXPECT_GE(stage_ms, 0);
    named_ms += stage_ms;
  }
  EXPECT_GT(named_ms, 0);
  EXPECT_LE(named_ms, times.total_ms * (1 + 1e-9));
  for (std::size_t p = 1; p < kModelWorkers.size(); ++p) {
    EXPECT_LE(times.model_ms[p], times.model_ms[p - 1] * (1 + 1e-9));
    EXPECT_GE(times.model_ms[p], times.total_ms / kModelWorkers[p] * (1 - 1e-9));
  }
  EXPECT_EQ(times.model_ms[0], times.total_ms);
  EXPECT_LE(times.critical_path_ms, times.model_ms.back() * (1 + 1e-9));
  EXPECT_GE(times.critical_path_ms, 0);
}

// Of every strategy that runs; a solver that leaves the test here takes no iterations of a strategy.
TEST_P(SolverContractTest, MaxIterationsIsAnEnd) {
  const bool of_strategies = !solver_halves(GetParam()).strategy.empty();
  EXPECT_EQ(has("max-iterations"), of_strategies);
  if (!of_strategies) return;
  const StepProblem problem = make_pile(13, {.columns = 3, .rows = 2, .layers = 3, .cfm = 1e-8});
  const std::vector<int> parts = sliced_parts(problem.body_count(), 4);
  Solution solution = cold_start(problem);
  const SolveSummary summary = make({}, "max-iterations", "1")->solve(problem, parts, solution);
  constexpr int kMostStrategies = 3, kMostAttempts = 3;
  EXPECT_GE(summary.iterations, 1);
  EXPECT_LE(summary.iterations, kMostStrategies * kMostAttempts);
  Solution patient = cold_start(problem);
  EXPECT_GT(solve(problem, parts, patient).iterations, summary.iterations);
}

TEST_P(SolverContractTest, OneThreadAloneIsModelledAndWhereItIsAsked) {
  const StepProblem problem = make_pile(13, {.columns = 3, .rows = 2, .layers = 3, .mu = 0});
  SolveOptions of_two;
  of_two.threads = 2;
  of_two.models_workers = true;
  for (const SolveOptions& options : {of_two, SolveOptions()}) {
    Solution solution = cold_start(problem);
    const SolveSummary summary = solve(problem, sliced_parts(problem.body_count(), 4), solution, options);
    EXPECT_GT(summary.times.total_ms, 0);
    for (const double model_ms : summary.times.model_ms) EXPECT_TRUE(std::isnan(model_ms));
  }
}

TEST_P(SolverContractTest, SaysWhatRan) {
  const StepProblem problem = make_chain(1, {.links = 5});
  Solution solution = cold_start(problem);
  const SolveSummary summary = solve(problem, sliced_parts(5, 2), solution);
  EXPECT_FALSE(summary.strategy.empty());
  EXPECT_FALSE(summary.kernel.empty());
  const std::string kernel = kernel_of(GetParam());
  if (!kernel.empty() && kernel != "auto") {
    EXPECT_EQ(summary.kernel, kernel);
  }
  if (!may_miss(GetParam())) {
    EXPECT_GE(summary.factorizations, 1);
  }
}

// A body that two rows want to have other velocities.
StepProblem make_wedge(double compliance) {
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 3, {1, 1, 1}, {0.1, 0, 0, 0, 0, 0});
  for (const double wanted : {1.0 / 3, -1.0 / 7})
    append_row(problem, {.jacobian_a = {1.1, 0, 0, 0, 0, 0}, .rhs = wanted, .compliance = compliance});
  return problem;
}

std::string reason_of(const StepProblem& problem) {
  const std::vector<int> part_of_body(1, 0);
  Solution solution{problem.warm_impulse, {}};
  return make_step_solver("exact", SolveOptions{})->solve(problem, part_of_body, solution).message;
}

// Impulses of 1e12 N s have last digits of 1e-4 N s; where nothing can be right, digits are not what is
// wrong.
TEST(StatusReason, NamesRoundingWhereItMayBeAllThatIsLeft) {
  EXPECT_EQ(reason_of(make_wedge(1e-4)), "");
  EXPECT_NE(reason_of(make_wedge(1e-12)).find("rounding of its impulses"), std::string::npos)
      << reason_of(make_wedge(1e-12));
  const std::string contradiction = reason_of(make_wedge(0));
  EXPECT_NE(contradiction.find("stopped above the limit"), std::string::npos) << contradiction;
  EXPECT_EQ(contradiction.find("rounding"), std::string::npos) << contradiction;
}

TEST(PivotTest, StartsFromAsManySweepsAsAskedFor) {
  // Soft, so that pivot itself comes to an end.
  const StepProblem problem = make_pile(13, {.columns = 3, .rows = 2, .layers = 3, .cfm = 1e-1});
  const auto iterations = [&](const std::string& sweeps) {
    Solution solution = cold_start(problem);
    const SolveSummary summary = make_step_solver("pivot:monolithic@predictor-sweeps=" + sweeps)
                                     ->solve(problem, own_parts(problem.body_count()), solution);
    EXPECT_EQ(summary.strategy, "pivot");
    return summary.iterations;
  };
  EXPECT_LT(iterations("200"), iterations("0"));
}

TEST(PgsTest, SweepsAsOftenAsAskedFor) {
  const StepProblem problem = make_pile(13, {.columns = 3, .rows = 2, .layers = 3, .cfm = 1e-8});
  for (const int sweeps : {0, 1, 7}) {
    Solution solution = cold_start(problem);
    const auto solver = make_step_solver("pgs@sweeps=" + std::to_string(sweeps));
    EXPECT_EQ(solver->solve(problem, own_parts(problem.body_count()), solution).iterations, sweeps);
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, SolverContractTest, testing::ValuesIn(all_solver_names()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

}  // namespace
}  // namespace cleave
