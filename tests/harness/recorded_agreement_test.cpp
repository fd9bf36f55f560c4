// Steps recorded from every scene, read back from their files and solved by every solver on every partition:
// all exact, all the same velocities. The alternation, which may cycle, says so where it does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/experiment/algorithms.h"
#include "harness/experiment/problem_graph.h"
#include "harness/experiment/splitter.h"
#include "harness/files/problem_file.h"
#include "partition/registry.h"
#include "solver/registry.h"
#include "solver/residual.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

constexpr double kAgreement_m_per_s = 1e-8;

struct RecordedScene {
  std::string name;  // of the directory
  Arguments options;
  std::string steps;
};

// Small, but with contacts, joints, several parts and several islands. Cold rocks, a chain as it comes to lie
// in the funnel, a tower at rest and hit by the ball, masses of 10, 100 and 1000 kg, a softer and a stiffer
// pile, a crane that lifts a rock by a motor.
const std::vector<RecordedScene> kScenes = {
    {"chain", {"--scene", "chain_drop", "--links", "24"}, "70,100"},
    {"short_chain", {"--scene", "chain_drop", "--links", "12"}, "69"},
    {"tower", {"--scene", "log_tower", "--layers", "5", "--logs", "3"}, "20,80"},
    {"pile", {"--scene", "rock_pile", "--bodies", "30"}, "40,120"},
    {"large_pile", {"--scene", "large_rock_pile", "--bodies", "30"}, "40,120"},
    {"soft_pile", {"--scene", "rock_pile", "--bodies", "30", "--cfm", "1e-3"}, "40,120"},
    {"stiff_pile", {"--scene", "large_rock_pile", "--bodies", "30", "--cfm", "1e-7"}, "120"},
    {"site",
     {"--scene", "mixed_site", "--links", "50", "--rings", "1", "--dt", "0.001", "--cfm", "1e-8"},
     "40"},
};

struct Recorded {
  std::string name;
  StepProblem problem;
  std::vector<double> position_m;
  std::vector<int> group;
};

// Those of the scene; where it names none, four in turn.
std::vector<int> groups_of(const ProblemFile& file) {
  std::vector<int> groups = known_groups(file);
  if (!groups.empty()) return groups;
  for (int body = 0; body < file.problem.body_count(); ++body) groups.push_back(body % 4);
  return groups;
}

class RecordedSteps : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new TemporaryDirectory;
    for (const RecordedScene& scene : kScenes) {
      Arguments arguments = {"record", "--at", scene.steps, "--out", *directory_ / scene.name};
      arguments.insert(arguments.end(), scene.options.begin(), scene.options.end());
      const ProgramResult result = run_cleave(arguments);
      ASSERT_EQ(result.exit_code, 0) << scene.name << ": " << result.err;
      std::map<std::string, ProblemFile> by_name;
      for (const auto& entry : std::filesystem::directory_iterator(*directory_ / scene.name))
        if (entry.path().extension() == ".h5")
          by_name[scene.name + "/" + entry.path().stem().string()] = read_problem_file(entry.path());
      for (auto& [name, file] : by_name) {
        std::vector<int> groups = groups_of(file);
        recorded_.push_back({name, std::move(file.problem), std::move(file.position), std::move(groups)});
      }
    }
  }
  static void TearDownTestSuite() {
    recorded_.clear();
    delete directory_;
  }

  static TemporaryDirectory* directory_;
  static std::vector<Recorded> recorded_;
};
TemporaryDirectory* RecordedSteps::directory_ = nullptr;
std::vector<Recorded> RecordedSteps::recorded_;

struct NamedParts {
  std::string name;
  std::vector<int> part_of_body;
};

// Every partitioner with every one of the refiners, and every body for itself.
std::vector<NamedParts> partitions_of(const Recorded& recorded, int max_bodies,
                                      const std::vector<std::string>& refiners) {
  const StepProblem& problem = recorded.problem;
  const CommonValues common = {{"max-bodies", std::to_string(max_bodies)}};
  std::vector<NamedParts> all;
  for (const Algorithm& partitioner : read_list("partitioner", "all", common))
    for (const std::string& refiner : refiners)
      all.push_back(
          {partitioner.name + "+" + refiner, Splitter({partitioner, read_named("refiner", refiner)})
                                                 .run(problem, {}, {recorded.position_m, recorded.group})
                                                 .parts.part_of_body});
  std::vector<int> own(problem.body_count());
  for (std::size_t body = 0; body < own.size(); ++body) own[body] = static_cast<int>(body);
  all.push_back({"own", own});
  return all;
}

// Aliases and strategy:kernel, without the strategies that may end without a solution.
std::vector<std::string> solvers_that_never_miss() {
  std::vector<std::string> names;
  for (const SolverRow& row : solver_table())
    if (row.alias.strategy != nullptr) names.emplace_back(row.name);
  for (const StrategyRow& strategy : strategy_table()) {
    const std::string name = strategy.name;
    if (name == "alternate" || name == "newton") continue;
    for (const KernelRow& kernel : kernel_table())
      if (runs_on(strategy, kernel)) names.push_back(name + ":" + kernel.name);
  }
  return names;
}

double largest_velocity_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = a.size() == b.size() ? 0 : std::nan("");
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(std::abs(a[i] - b[i]) <= largest)) largest = std::abs(a[i] - b[i]);
  return largest;
}

Solution start_from(const StepProblem& problem, bool warm) {
  Solution solution;
  solution.impulse = problem.warm_impulse;
  if (!warm) std::ranges::fill(solution.impulse, 0.0);
  return solution;
}

// Solves cold and warm; both must be exact and have the velocities expected.
void expect_solution(const StepProblem& problem, StepSolver& solver, const std::vector<int>& part_of_body,
                     const std::vector<double>& expected_velocity) {
  for (const bool warm : {false, true}) {
    Solution solution = start_from(problem, warm);
    const SolveSummary summary = solver.solve(problem, part_of_body, solution);
    const ResidualReport report = judge(problem, solution.impulse);
    EXPECT_EQ(summary.status, SolveStatus::ok) << (warm ? "warm: " : "cold: ") << summary.message;
    EXPECT_TRUE(report.exact) << (warm ? "warm" : "cold") << ", residual " << report.residual_m_per_s;
    EXPECT_LE(largest_velocity_difference(report.velocity, expected_velocity), kAgreement_m_per_s);
    EXPECT_LE(largest_velocity_difference(solution.velocity, expected_velocity), kAgreement_m_per_s);
  }
}

TEST_F(RecordedSteps, AreProblemsWorthSolving) {
  ASSERT_EQ(recorded_.size(), 13u);
  int several_islands = 0;
  for (const auto& [name, problem, position_m, group] : recorded_) {
    EXPECT_GE(std::ranges::count(problem.row_kind, RowKind::normal), 8) << name;
    EXPECT_GE(std::ranges::count(problem.row_kind, RowKind::friction), 16) << name;
    several_islands += count_islands(body_graph_of(problem)) > 1;
  }
  EXPECT_GE(several_islands, 4);
}

TEST_F(RecordedSteps, EverySolverOnEveryPartitionFindsTheSameVelocities) {
  for (const Recorded& recorded : recorded_) {
    const auto& [name, problem, position_m, group] = recorded;
    Solution reference = start_from(problem, false);
    make_step_solver("dense", {})->solve(problem, std::vector<int>(problem.body_count(), 0), reference);
    const ResidualReport report = judge(problem, reference.impulse);
    ASSERT_TRUE(report.exact) << name;
    const std::vector<NamedParts> partitions = partitions_of(recorded, 5, {"none", "fm"});
    for (const std::string& solver_name : solvers_that_never_miss()) {
      const auto solver = make_step_solver(solver_name, {});
      for (const auto& [parts_name, part_of_body] : partitions) {
        SCOPED_TRACE(name + " " + solver_name + " " + parts_name);
        expect_solution(problem, *solver, part_of_body, report.velocity);
        if (!solver->uses_partition()) break;
      }
    }
  }
}

// ok if and only if the judge agrees, a miss has a message. What decides is stiffness: the soft pile is
// solved, the stiff one is not.
TEST_F(RecordedSteps, AlternationIsExactOrSaysThatItIsNot) {
  std::map<std::string, int> solved, missed;  // by scene
  for (const Recorded& recorded : recorded_) {
    const auto& [name, problem, position_m, group] = recorded;
    const auto solver = make_step_solver("alternate:schur-rows", {});
    for (const auto& [parts_name, part_of_body] : partitions_of(recorded, 5, {"none"})) {
      SCOPED_TRACE(name + " " + parts_name);
      Solution solution = start_from(problem, false);
      const SolveSummary summary = solver->solve(problem, part_of_body, solution);
      const ResidualReport report = judge(problem, solution.impulse);
      EXPECT_EQ(summary.status == SolveStatus::ok, report.exact) << report.residual_m_per_s;
      EXPECT_EQ(summary.strategy, "alternate");
      EXPECT_EQ(summary.fallbacks, 0);
      const std::string scene = name.substr(0, name.find('/'));
      if (summary.status == SolveStatus::ok) {
        ++solved[scene];
      } else {
        ++missed[scene];
        EXPECT_EQ(summary.status, SolveStatus::not_converged);
        EXPECT_FALSE(summary.message.empty());
      }
    }
  }
  EXPECT_GT(solved["soft_pile"], missed["soft_pile"]);
  EXPECT_LT(solved["stiff_pile"], missed["stiff_pile"]);
}

// The same through the program: a cell that cycles is a row that says so, and the exit code tells.
TEST_F(RecordedSteps, AlternationThatCyclesIsAFailedCellOfAReplay) {
  const std::string file = *directory_ / "stiff_pile" / "large_rock_pile_step000120.h5";
  const ProgramResult result = run_cleave({"replay", file, "--solver", "alternate:schur-rows,schur",
                                           "--partitioner", "mindp", "--refiner", "none", "--max-bodies", "5",
                                           "--repeats", "1", "--cold", "--out", *directory_ / "replayed"});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  const CsvTable table = read_csv(*directory_ / "replayed/steps.csv");
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.column("status"), (Arguments{"not_converged", "ok"}));
  EXPECT_EQ(table.at(0, "fallbacks"), "0");
  EXPECT_GT(std::stod(table.at(0, "residual_m_per_s")), 1e-9);
  EXPECT_NE(result.err.find("alternate:schur-rows: not_converged"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace cleave
