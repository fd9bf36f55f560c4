// Peers that take boxes: the same answers as ours, by the judge and by velocities, and refusals by name.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "harness/peers/peer_solver.h"
#include "harness/peers/peer_table.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

// A row of a library that nobody has, beside those there are. Before the tables are asked for.
const bool kAdded = [] {
  add_solvers(peer_table());
  SolverRow absent{{"absent", "-", "-"}, nullptr};
  absent.unavailable = "install libabsent-dev and build again";
  add_solvers(std::span(&absent, 1));
  return true;
}();

// Skips the test loudly where its library was not there.
#define SKIP_WITHOUT(peer) \
  if (const std::string why = missing(peer); !why.empty()) GTEST_SKIP() << (peer) << ": " << why

// What to install for a peer that this build has not; empty where it has.
std::string missing(std::string text) {
  for (const SolverRow& row : peer_table())
    if (row.name == algorithm_name(text)) return row.unavailable;
  return "no such peer";
}

// Those of a list that this build has; says which it has not.
std::vector<std::string> available(const std::vector<std::string>& peers) {
  std::vector<std::string> there;
  for (const std::string& peer : peers)
    if (missing(peer).empty()) {
      there.push_back(peer);
    } else {
      std::cerr << "not tested: " << peer << ", " << missing(peer) << "\n";
    }
  return there;
}

// How near to the solution a peer comes by itself, m/s; it is the library's word against the judge's.
constexpr double kVelocityTolerance = 1e-6;

Solution solved(const std::string& text, const StepProblem& problem, SolveSummary& summary) {
  Solution solution = cold_start(problem);
  summary = make_step_solver(text)->solve(problem, {}, solution);
  return solution;
}

Solution ours(const StepProblem& problem) {
  SolveSummary summary;
  const Solution solution = solved("exact", problem, summary);
  EXPECT_TRUE(is_exact(problem, summary, solution));
  return solution;
}

// Piles and chains, whose bounds hold zero, as Dantzig's method in engines wants them.
std::vector<StepProblem> problems() {
  std::vector<StepProblem> all;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    all.push_back(make_pile(seed, {.columns = 2, .rows = 1, .layers = 2, .cfm = 1e-4}));
    all.push_back(make_pile(seed, {.columns = 2, .rows = 1, .layers = 2, .cfm = 1e-4, .mu = 0}));
    all.push_back(make_chain(seed, {.links = 6, .cfm = 1e-4}));
  }
  return all;
}

class DirectPeer : public testing::TestWithParam<const char*> {};

TEST_P(DirectPeer, FindsTheSolution) {
  SKIP_WITHOUT(GetParam());
  for (const StepProblem& problem : problems()) {
    SolveSummary summary;
    const Solution solution = solved(GetParam(), problem, summary);
    EXPECT_TRUE(is_exact(problem, summary, solution));
    EXPECT_TRUE(velocities_agree(problem, solution.velocity, ours(problem).velocity, kVelocityTolerance));
    EXPECT_GT(summary.times.total_ms, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Peers, DirectPeer, testing::Values("bullet-dantzig", "dart-dantzig"),
                         [](const auto& info) {
                           const std::string name = info.param;
                           return name.substr(0, name.find('-'));
                         });

// An interior point ends beside the solution: near it by the judge, and honest about the rest.
TEST(Ipopt, ComesNearTheSolution) {
  SKIP_WITHOUT("ipopt");
  for (const StepProblem& problem : problems()) {
    SolveSummary summary;
    const Solution solution = solved("ipopt@peer-tolerance=1e-12", problem, summary);
    EXPECT_TRUE(is_honest(problem, summary, solution));
    EXPECT_LE(judge(problem, solution.impulse).residual_m_per_s, 1e-6);
    EXPECT_TRUE(velocities_agree(problem, solution.velocity, ours(problem).velocity, kVelocityTolerance));
    EXPECT_GT(summary.iterations, 0);
  }
}

// Small problems of every kind of row, with zero within all bounds.
StepProblem small_problem(std::uint64_t seed) {
  return make_small_problem(
      seed, {.least_cfm = 1e-4, .mass_ratio = 10, .zero_inside_bounds = true, .feasible = true});
}

TEST(PeersOnBoxes, SolveSmallProblems) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed)
    for (const std::string& peer :
         available({"bullet-dantzig", "dart-dantzig", "bullet-pgs@sweeps=10000", "dart-pgs@sweeps=10000"})) {
      const StepProblem problem = small_problem(seed);
      SolveSummary summary;
      const Solution solution = solved(peer, problem, summary);
      EXPECT_TRUE(is_exact(problem, summary, solution)) << peer << ", seed " << seed;
    }
}

// It misses some of them, and reports success; the judge says what is true.
TEST(BulletLemke, SolvesMostSmallProblemsAndIsToldWhereNot) {
  SKIP_WITHOUT("bullet-lemke");
  int exact = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const StepProblem problem = small_problem(seed);
    SolveSummary summary;
    const Solution solution = solved("bullet-lemke", problem, summary);
    EXPECT_TRUE(is_honest(problem, summary, solution)) << "seed " << seed;
    exact += summary.status == SolveStatus::ok;
  }
  EXPECT_GE(exact, 20);
}

TEST(BulletLemke, FindsTheSolutionOfOneContact) {
  SKIP_WITHOUT("bullet-lemke");
  StepProblem problem;
  problem.h_s = kTestStep_s;
  append_body(problem, 2, {1, 1, 1}, {0.1, 0, -1, 0, 0, 0});
  const double infinity = std::numeric_limits<double>::infinity();
  append_row(
      problem,
      {.jacobian_a = {0, 0, 1}, .compliance = 1e-3, .lower = 0, .upper = infinity, .kind = RowKind::normal});
  append_row(problem, {.jacobian_a = {1},
                       .compliance = 1e-3,
                       .lower = -0.1,
                       .upper = 0.1,
                       .kind = RowKind::friction,
                       .friction_row = 0,
                       .friction_coefficient = 0.5});
  append_row(problem, {.jacobian_a = {0, 1},
                       .compliance = 1e-3,
                       .lower = -0.1,
                       .upper = 0.1,
                       .kind = RowKind::friction,
                       .friction_row = 0,
                       .friction_coefficient = 0.5});
  SolveSummary summary;
  const Solution solution = solved("bullet-lemke", problem, summary);
  EXPECT_TRUE(is_honest(problem, summary, solution));
  EXPECT_NEAR(solution.impulse[0], 1 / (0.5 + 1e-3), 1e-8);
  EXPECT_NEAR(solution.impulse[1], -0.1, 1e-8);
  EXPECT_NEAR(solution.impulse[2], 0, 1e-8);
}

// Three programs that do the same sweeps: the impulses are ours, sweep for sweep.
TEST(PeersOnBoxes, GaussSeidelIsOurs) {
  for (const StepProblem& problem : problems())
    for (const char* sweeps : {"@sweeps=1", "@sweeps=7"}) {
      SolveSummary summary;
      const Solution expected = solved(std::string("pgs") + sweeps, problem, summary);
      for (const std::string& peer : available({"bullet-pgs", "dart-pgs"})) {
        const Solution solution = solved(peer + sweeps, problem, summary);
        EXPECT_TRUE(is_honest(problem, summary, solution));
        EXPECT_TRUE(velocities_agree(problem, solution.velocity, expected.velocity, 1e-11)) << peer << sweeps;
      }
    }
}

TEST(PeersOnBoxes, TheSameBytesEveryTime) {
  const StepProblem problem = make_pile(5, {.columns = 2, .rows = 2, .layers = 2, .cfm = 1e-4});
  for (const std::string& peer :
       available({"bullet-dantzig", "dart-dantzig", "ipopt", "bullet-pgs", "dart-pgs"})) {
    SolveSummary summary;
    const Solution first = solved(peer, problem, summary);
    for (int i = 0; i < 3; ++i)
      EXPECT_TRUE(same_bytes(solved(peer, problem, summary).impulse, first.impulse)) << peer;
  }
}

TEST(PeersOnBoxes, RefuseWhatTheyDoNotTake) {
  StepProblem pile = make_pile(1, {.columns = 1, .rows = 1, .layers = 1, .cfm = 1e-4});
  SolveSummary summary;
  SKIP_WITHOUT("dart-dantzig");
  solved("dart-dantzig@peer-max-rows=11", pile, summary);
  EXPECT_EQ(summary.status, SolveStatus::refused);
  EXPECT_EQ(summary.message, "12 rows, more than --peer-max-rows 11");

  pile.box_angle_rad.assign(pile.row_count(), 0);
  pile.box_angle_rad[0] = 0.3;
  solved("dart-pgs", pile, summary);
  EXPECT_EQ(summary.status, SolveStatus::refused);
  EXPECT_NE(summary.message.find("dart-pgs"), std::string::npos) << summary.message;
}

TEST(PeersOnBoxes, ALibraryThatIsAbsentIsSaidToBe) {
  try {
    make_step_solver("absent");
    FAIL() << "made";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("libabsent-dev"), std::string::npos) << error.what();
  }
  for (const SolverRow& row : peer_table())
    EXPECT_EQ(row.make == nullptr, !row.unavailable.empty()) << row.name;
}

// A library that says it is done and is not; one whose impulses are no numbers.
PeerAnswer claim(const StepProblem& problem, std::span<const double>, const Settings&) {
  return {.claims_success = true,
          .message = "",
          .solve_ms = 1,
          .impulse = std::vector<double>(problem.row_count(), 0.0)};
}
PeerAnswer no_numbers(const StepProblem& problem, std::span<const double>, const Settings&) {
  return {.claims_success = true,
          .message = "",
          .solve_ms = 1,
          .impulse = std::vector<double>(problem.row_count(), NAN)};
}

TEST(PeersOnBoxes, TheJudgeHasTheLastWord) {
  const StepProblem pile = make_pile(1, {.columns = 1, .rows = 1, .layers = 1, .cfm = 1e-4});
  const Settings settings({{"peer-max-rows", "100"}, {"peer-timeout-s", "60"}});
  Solution solution = cold_start(pile);
  EXPECT_EQ(PeerSolver("claim", claim, ContactSet::box, {}, settings).solve(pile, {}, solution).status,
            SolveStatus::not_converged);
  EXPECT_EQ(PeerSolver("none", no_numbers, ContactSet::box, {}, settings).solve(pile, {}, solution).status,
            SolveStatus::diverged);
}

}  // namespace
}  // namespace cleave
