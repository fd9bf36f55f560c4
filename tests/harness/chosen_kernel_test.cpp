// Kernel `chosen` as a solver of its own, and behind partitioner auto as a user gives it.
#include "harness/experiment/chosen_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/base/names.h"
#include "harness/commands/stored_partition.h"
#include "harness/experiment/algorithms.h"
#include "harness/experiment/splitter.h"
#include "harness/files/checksums.h"
#include "harness/files/problem_file.h"
#include "partition/calibration.h"
#include "partition/partition.h"
#include "solver/registry.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
const Arguments kPile = {"--scene", "rock_pile", "--bodies", "40"};

std::vector<std::string> kernels() { return {cost_kernel_names().begin(), cost_kernel_names().end()}; }

class ChosenKernel : public testing::Test {
 public:
  static void SetUpTestSuite() {
    recorded_ = new TemporaryDirectory;
    const Arguments record = Arguments{"record", "--at", "100,101,102", "--out", *recorded_ / "made"} + kPile;
    ASSERT_EQ(run_cleave(record).exit_code, 0);
  }
  static void TearDownTestSuite() { delete recorded_; }

  static std::string file(int step) {
    return *recorded_ / ("made/rock_pile_step000" + std::to_string(step) + ".h5");
  }

  static StepProblem problem(int step) { return read_problem_file(file(step)).problem; }

  static SolveSummary solve(StepSolver& solver, const StepProblem& problem, std::string_view kernel,
                            Solution& solution) {
    std::vector<int> halves(problem.body_count());
    for (int body = 0; body < problem.body_count(); ++body) halves[body] = 2 * body / problem.body_count();
    Parts parts(halves);
    parts.kernel = kernel;
    solution.impulse = problem.warm_impulse;
    return solver.solve(problem, parts, solution);
  }

 private:
  static TemporaryDirectory* recorded_;
};
TemporaryDirectory* ChosenKernel::recorded_ = nullptr;

TEST_F(ChosenKernel, HasEveryStrategyThatRunsOnAnyKernel) {
  EXPECT_EQ(chosen_kernel_solvers(), (std::vector<std::string>{"pivot:chosen", "newton:chosen",
                                                               "interior-point:chosen", "auto:chosen"}));
  const auto names = [](const std::vector<Parameter>& parameters) { return names_of(std::span(parameters)); };
  for (const std::string& kernel : kernels()) {
    std::vector<std::string> of_kernel = names(solver_parameters("pivot:" + kernel));
    std::erase(of_kernel, "arity");  // the tree is there when the kernel is chosen
    EXPECT_EQ(names(chosen_kernel_parameters("pivot:chosen")), of_kernel);
  }
  EXPECT_TRUE(chosen_kernel_parameters("pivot:dense").empty());
  EXPECT_THROW(read_named("solver", "alternate:chosen"), std::invalid_argument);
}

TEST_F(ChosenKernel, SolvesAsTheNamedKernelDoes) {
  const StepProblem problem = ChosenKernel::problem(100);
  for (const char* strategy : {"pivot", "auto"}) {
    const auto chosen = make_solver(read_named("solver", std::string(strategy) + ":chosen"), {}, {});
    for (const std::string& kernel : kernels()) {
      SCOPED_TRACE(kernel);
      Solution found, expected;
      const auto named = make_step_solver(strategy + (":" + kernel));
      const SolveSummary summary = solve(*chosen, problem, kernel, found);
      EXPECT_EQ(summary.status, SolveStatus::ok);
      EXPECT_EQ(summary.kernel, kernel);
      EXPECT_EQ(summary.factorizations, solve(*named, problem, kernel, expected).factorizations);
      EXPECT_EQ(found.impulse, expected.impulse);
      EXPECT_EQ(found.velocity, expected.velocity);
    }
  }
}

TEST_F(ChosenKernel, ASessionOfAnotherKernelBeginsAnew) {
  const StepProblem first = problem(100), second = problem(101), third = problem(102);
  const auto chosen = make_solver(read_named("solver", "auto:chosen"), {.session = true}, {});
  Solution found, expected;
  solve(*chosen, first, "schur-rows", found);
  solve(*chosen, second, "monolithic", found);
  const SolveSummary summary = solve(*chosen, third, "monolithic", found);
  const auto named = make_step_solver("auto:monolithic", {.session = true});
  solve(*named, second, "monolithic", expected);
  EXPECT_EQ(summary.factor_reuses, solve(*named, third, "monolithic", expected).factor_reuses);
  EXPECT_EQ(found.impulse, expected.impulse);
}

TEST_F(ChosenKernel, PartsForNoKernelAreRefusedByName) {
  const StepProblem problem = ChosenKernel::problem(100);
  const auto chosen = make_solver(read_named("solver", "pivot:chosen"), {}, {});
  for (const char* kernel : {"", "dense", "schur-part"}) {
    Solution solution;
    const SolveSummary summary = solve(*chosen, problem, kernel, solution);
    EXPECT_EQ(summary.status, SolveStatus::refused);
    const std::string named = *kernel == 0 ? "no kernel" : "kernel '" + std::string(kernel) + "'";
    EXPECT_EQ(summary.message, "kernel chosen: parts are for " + named +
                                   ", allowed: schur-rows, schur-bodies, schur-nested, monolithic, of which "
                                   "partitioner auto chooses");
    EXPECT_EQ(solution.impulse, problem.warm_impulse);
  }
}

// By which a solve of one kernel costs 1 us and of the others 2; and, where flops are to cost something,
// factoring its parts.
std::string calibration_of_cheapest(CostKernel cheapest, const fs::path& path, double ns_per_flop = 0) {
  std::vector<KernelCost> costs;
  for (std::size_t k = 0; k < cost_kernel_names().size(); ++k) {
    const CostKernel kernel = static_cast<CostKernel>(k);
    costs.push_back({kernel, 1, ExpectedFactorizations::always(1), {}, {}});
    costs.back().cost[0] = kernel == cheapest ? 1 : 1e9;
    costs.back().cost[7] = ns_per_flop;
  }
  std::ofstream(path, std::ios::binary) << calibration_text({}, costs);
  return path;
}

// By auto, among all kernels.
Arguments chosen_by(const std::string& calibration, const std::string& solver) {
  return {"--partitioner", "auto",          "--refiner", "none",     "--cost-kernel",
          "any",           "--calibration", calibration, "--solver", solver};
}

TEST_F(ChosenKernel, RunsTheKernelOfTheChoice) {
  const TemporaryDirectory directory;
  for (std::size_t k = 0; k < kernels().size(); ++k) {
    const std::string kernel = kernels()[k];
    const std::string file =
        calibration_of_cheapest(static_cast<CostKernel>(k), directory / (kernel + ".toml"));
    const fs::path out = directory / kernel;
    const Arguments run = {"run", "--steps", "60", "--measure-every", "30", "--out", out};
    ASSERT_EQ(run_cleave(run + kPile + chosen_by(file, "pivot:chosen,pivot:" + kernel)).exit_code, 0);
    const CsvTable rows = read_csv(out / "steps.csv");
    std::map<std::string, std::set<std::string>> hashes;  // of each step
    ASSERT_EQ(rows.rows.size(), 4u);
    for (std::size_t row = 0; row < rows.rows.size(); ++row) {
      EXPECT_EQ(rows.at(row, "kernel"), kernel);
      if (rows.at(row, "solver") == "pivot:chosen") {
        EXPECT_EQ(rows.at(row, "auto_choice"), "single+none/" + kernel);
        EXPECT_EQ(rows.at(row, "cost_kernel"), "any");
      }
      // A solver that ignores parts has none in its hash.
      if (kernel != "monolithic") hashes[rows.at(row, "step")].insert(rows.at(row, "solution_hash"));
    }
    for (const auto& [step, of_step] : hashes) EXPECT_EQ(of_step.size(), 1u) << step;
  }
}

// The tree that was chosen is what schur-nested works on, is stored, and is made again from the choice.
TEST_F(ChosenKernel, ATreeIsChosenAndKept) {
  const TemporaryDirectory directory;
  const std::string file = calibration_of_cheapest(CostKernel::schur_nested, directory / "nested.toml", 1);
  const fs::path out = directory / "out", tower = directory / "made/log_tower_step000020.h5";
  ASSERT_EQ(run_cleave({"record", "--scene", "log_tower", "--layers", "10", "--at", "20", "--out",
                        directory / "made"})
                .exit_code,
            0);
  const Arguments replay = {"replay", tower, "--write-solutions", "--out", out};
  ASSERT_EQ(
      run_cleave(replay + chosen_by(file, "pivot:chosen,pivot:schur-nested,pivot:schur-bodies")).exit_code,
      0);
  const CsvTable rows = read_csv(out / "steps.csv");
  ASSERT_EQ(rows.rows.size(), 3u);
  EXPECT_EQ(rows.at(0, "kernel"), "schur-nested");
  const std::string choice = rows.at(0, "auto_choice");
  EXPECT_NE(choice.find("@max-bodies=10"), std::string::npos) << choice;
  EXPECT_NE(choice.find("/schur-nested"), std::string::npos) << choice;
  EXPECT_EQ(rows.at(0, "solution_hash"), rows.at(1, "solution_hash"));
  EXPECT_EQ(rows.at(0, "parts"), rows.at(2, "parts"));
  const ProblemFile written = read_problem_file(out / tower.filename());
  read_calibration("--calibration", file);
  ASSERT_EQ(written.partitions.size(), 3u);
  for (const auto& [label, partition] : written.partitions) {
    EXPECT_GT(partition.parent_of_part.size(), partition.part_of_body.size() / 10) << label;
    const Split again = Splitter(read_split_setup(partition)).run(written.problem, written.step);
    EXPECT_EQ(again.parts.part_of_body, partition.part_of_body) << label;
    EXPECT_EQ(again.parts.parent_of_part, partition.parent_of_part) << label;
  }
}

const Arguments kAny = {"--partitioner", "auto@cost-kernel=any,auto@cost-kernel=schur-bodies",
                        "--refiner",     "none",
                        "--solver",      "auto:chosen"};

TEST_F(ChosenKernel, GoesThroughEveryCommand) {
  const TemporaryDirectory directory;
  const std::vector<Arguments> commands = {
      Arguments{"run", "--steps", "60", "--measure-every", "20", "--repeats", "2"} + kPile,
      Arguments{"run", "--steps", "60", "--measure-every", "20", "--session"} + kPile,
      Arguments{"run", "--steps", "60", "--measure-every", "20", "--repartition", "on-change", "--model",
                "auto"} +
          kPile,
      Arguments{"replay", "--write-solutions", file(100), file(102)},
  };
  for (std::size_t k = 0; k < commands.size(); ++k) {
    SCOPED_TRACE(k);
    const fs::path out = directory / std::to_string(k), again = directory / (std::to_string(k) + "again");
    const ProgramResult result = run_cleave(commands[k] + kAny + Arguments{"--out", out});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ProgramResult verified = run_cleave({"verify", out});
    EXPECT_EQ(verified.exit_code, 0) << verified.out;
    const CsvTable rows = read_csv(out / "steps.csv");
    for (std::size_t row = 0; row < rows.rows.size(); ++row)
      EXPECT_EQ(rows.at(row, "kernel"), kernel_of_choice(rows.at(row, "auto_choice"))) << row;
    const ProgramResult repeated =
        run_cleave({commands[k].front(), "--config", out / "manifest.json", "--out", again});
    ASSERT_EQ(repeated.exit_code, 0) << repeated.err;
    for (const char* column : {"run_id", "auto_choice", "kernel", "solution_hash"})
      EXPECT_EQ(read_csv(again / "steps.csv").column(column), rows.column(column)) << column;
  }
}

TEST_F(ChosenKernel, RowsOfOtherPartitionersSayThatTheyChooseNone) {
  const TemporaryDirectory directory;
  const fs::path out = directory / "out";
  const Arguments replay = {"replay", file(100), "--refiner",  "none",     "--repeats",
                            "1",      "--out",   out.string(), "--solver", "auto:chosen"};
  EXPECT_EQ(run_cleave(replay + Arguments{"--partitioner", "mindp,auto"}).exit_code, 2);
  const CsvTable rows = read_csv(out / "steps.csv");
  ASSERT_EQ(rows.rows.size(), 2u);
  EXPECT_EQ(rows.at(0, "status"), "refused");
  EXPECT_EQ(rows.at(0, "status_reason").find("kernel chosen: parts are for no kernel, allowed: "), 0u)
      << rows.at(0, "status_reason");
  EXPECT_EQ(rows.at(1, "status"), "ok");
  EXPECT_EQ(rows.at(1, "kernel"), "schur-rows");
  EXPECT_EQ(run_cleave({"verify", out}).exit_code, 0);
  const ProgramResult all = run_cleave(replay + Arguments{"--partitioner", "all", "--force"});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_NE(all.err.find("mindp, which chooses its parts for no kernel, as auto:chosen needs"),
            std::string::npos)
      << all.err;
  EXPECT_EQ(read_csv(out / "steps.csv").column("partitioner"), std::vector<std::string>{"auto"});
}

TEST_F(ChosenKernel, VerifyFindsAKernelThatWasNotChosen) {
  const TemporaryDirectory directory;
  const fs::path out = directory / "out";
  ASSERT_EQ(run_cleave(Arguments{"replay", file(100), "--repeats", "1", "--out", out} + kAny).exit_code, 0);
  std::string text = read_text(out / "steps.csv");
  const std::string kernel = "," + read_csv(out / "steps.csv").at(0, "kernel") + ",";
  text.replace(text.find(kernel), kernel.size(), ",dense,");
  std::ofstream(out / "steps.csv", std::ios::binary) << text;
  write_checksums(out, {"manifest.json", "steps.csv"});
  const ProgramResult verified = run_cleave({"verify", out});
  EXPECT_EQ(verified.exit_code, 3);
  EXPECT_NE(verified.out.find("kernel = dense, allowed: "), std::string::npos) << verified.out;
}

TEST_F(ChosenKernel, CanBeGivenToOthersAsTheirKernel) {
  const TemporaryDirectory directory;
  const Arguments replay = {"replay",   file(100),  "--refiner", "none",           "--partitioner",
                            "auto",     "--kernel", "chosen",    "--repeats",      "1",
                            "--solver", "exact",    "--out",     directory / "out"};
  const ProgramResult result = run_cleave(replay);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(read_csv(directory / "out/steps.csv").at(0, "solver"), "auto:chosen");
  EXPECT_NE(run_cleave({"list", "kernels", "--names"}).out.find("\nchosen\n"), std::string::npos);
}

}  // namespace
}  // namespace cleave
