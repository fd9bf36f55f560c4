// --body-order: other numbers change the parts that are found, and nothing else.
#include <gtest/gtest.h>

#include <fstream>
#include <numeric>
#include <stdexcept>

#include "harness/experiment/algorithms.h"
#include "harness/experiment/splitter.h"
#include "tests/harness/problem_file_sample.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
const Arguments kPile = {"run",     "--scene",         "rock_pile", "--bodies",      "40",        "--steps",
                         "60",      "--measure-every", "20",        "--partitioner", "bfs,mindp", "--refiner",
                         "none,fm", "--repeats",       "1",         "--max-bodies",  "8"};

CsvTable rows_of(const Arguments& arguments, const fs::path& out) {
  const ProgramResult result = run_cleave(arguments + Arguments{"--out", out});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return read_csv(out / "steps.csv");
}

std::string refusal(const Arguments& more) {
  const TemporaryDirectory directory;
  const ProgramResult result = run_cleave(kPile + more + Arguments{"--out", directory / "out"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(count_lines(result.err), 1) << result.err;
  EXPECT_FALSE(fs::exists(directory / "out"));
  return result.err;
}

// Splitting by numbers is splitting the problem whose bodies have them.
TEST(BodyOrder, IsSplittingARenumberedProblem) {
  const StepProblem problem = sample_problem(60, 3);
  const BodyOrder order = read_body_order("--body-order", "random@seed=4");
  const std::vector<int> number = order.numbers(60, std::nullopt);
  StepProblem other = problem;
  for (int& body : other.row_body)
    if (body >= 0) body = number[body];
  for (int i = 0; i < 60; ++i)
    std::copy_n(problem.mass.begin() + 36 * i, 36, other.mass.begin() + 36 * number[i]);
  for (const std::string& partitioner : std::vector<std::string>{"bfs", "mindp", "mr", "multilevel"})
    for (const std::optional<int> arity : {std::optional<int>(), std::optional<int>(3)}) {
      SplitSetup setup{read_named("partitioner", partitioner + "@max-bodies=7"), read_named("refiner", "fm"),
                       false, arity};
      const Split expected = Splitter(setup).run(other);
      setup.order = order;
      const Split found = Splitter(setup).run(problem);
      EXPECT_EQ(found.parts.parent_of_part, expected.parts.parent_of_part);
      for (int i = 0; i < 60; ++i) {
        EXPECT_EQ(found.parts.part_of_body[i], expected.parts.part_of_body[number[i]]) << partitioner;
        EXPECT_EQ(found.before.part_of_body[i], expected.before.part_of_body[number[i]]) << partitioner;
        EXPECT_EQ(found.graph.mass_kg(i), problem.mass[36 * i]);
      }
    }
}

TEST(BodyOrder, LeavesProblemsAndMotionAlone) {
  const TemporaryDirectory directory;
  const CsvTable scene = rows_of(kPile, directory / "scene");
  const CsvTable random = rows_of(kPile + Arguments{"--body-order", "random@seed=2"}, directory / "random");
  for (const char* column : {"step", "partitioner", "problem_hash", "state_hash", "rows", "islands"})
    EXPECT_EQ(random.column(column), scene.column(column)) << column;
  EXPECT_NE(random.column("interface_rows"), scene.column("interface_rows"));
  EXPECT_NE(random.column("solution_hash"), scene.column("solution_hash"));
  EXPECT_EQ(scene.at(0, "body_order"), "scene");
  EXPECT_EQ(random.at(0, "body_order"), "random@seed=2");
  EXPECT_NE(random.at(0, "run_id"), scene.at(0, "run_id"));
  EXPECT_EQ(run_cleave({"verify", directory / "random"}).exit_code, 0);
}

class BodyOrderOfAFile : public testing::Test {
 protected:
  void SetUp() override {
    const ProgramResult result = run_cleave(
        {"record", "--scene", "rock_pile", "--bodies", "20", "--at", "80", "--out", directory_ / "recorded"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  std::string write(const std::string& name, int bodies, bool backwards) {
    std::ofstream file(directory_ / name, std::ios::binary);
    for (int i = 0; i < bodies; ++i) file << (backwards ? bodies - 1 - i : i) << "\n";
    return directory_ / name;
  }
  ProgramResult replay(const std::string& order, const std::string& out) {
    return run_cleave({"replay", directory_ / "recorded/rock_pile_step000080.h5", "--partitioner", "bfs",
                       "--refiner", "fm", "--max-bodies", "6", "--repeats", "1", "--write-solutions",
                       "--body-order", order, "--out", directory_ / out});
  }
  TemporaryDirectory directory_;
};

TEST_F(BodyOrderOfAFile, InTheScenesOrderIsTheScenes) {
  ASSERT_EQ(replay("scene", "scene").exit_code, 0);
  ASSERT_EQ(replay("file@" + write("numbers", 20, false), "same").exit_code, 0);
  ASSERT_EQ(replay("file@" + (directory_ / "none_{step}").string(), "none").exit_code, 1);
  const CsvTable scene = read_csv(directory_ / "scene/steps.csv"),
                 same = read_csv(directory_ / "same/steps.csv");
  for (const char* column : {"problem_hash", "solution_hash", "interface_rows", "parts"})
    EXPECT_EQ(same.at(0, column), scene.at(0, column)) << column;
  EXPECT_TRUE(same.at(0, "body_order").starts_with("file@")) << same.at(0, "body_order");
  EXPECT_EQ(same.at(0, "body_order").find('/'), std::string::npos);
}

TEST_F(BodyOrderOfAFile, IsVerifiedAsFarAsItCanBe) {
  for (const std::string& order :
       std::vector<std::string>{"file@" + write("back", 20, true), "random", "scene"}) {
    const std::string out = "out_" + order.substr(0, 4);
    ASSERT_EQ(replay(order, out).exit_code, 0) << order;
    const ProgramResult result = run_cleave({"verify", directory_ / out});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_EQ(result.err.find("file of its body order is not here") != std::string::npos, order[0] == 'f')
        << result.err;
  }
}

TEST_F(BodyOrderOfAFile, OfAnotherNumberOfBodiesIsARefusedRow) {
  const ProgramResult result = replay("file@" + write("short", 19, true), "out");
  EXPECT_EQ(result.exit_code, 2) << result.err;
  const CsvTable rows = read_csv(directory_ / "out/steps.csv");
  EXPECT_EQ(rows.at(0, "status"), "refused");
  EXPECT_NE(rows.at(0, "status_reason").find("19 lines, allowed: 20"), std::string::npos)
      << rows.at(0, "status_reason");
}

TEST_F(BodyOrderOfAFile, MustGiveEveryNumberOnce) {
  std::ofstream(directory_ / "twice", std::ios::binary) << "0\n1\n1\n";
  const ProgramResult result = replay("file@" + (directory_ / "twice").string(), "out");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(count_lines(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("--body-order: "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("2 different numbers on 3 lines, allowed: each of 0 to 2 once"),
            std::string::npos)
      << result.err;
}

TEST(BodyOrder, NamesWhatIsWrong) {
  const struct {
    std::string text, piece;
  } mistakes[] = {
      {"randm", "did you mean 'random'?"},
      {"scene@seed=1", "random@seed=N"},
      {"random@sed=1", "random@seed=N"},
      {"random@seed=-1", "[0, 2^64)"},
      {"file", "file@PATH"},
      {"file@/nowhere/at/all", "/nowhere/at/all"},
  };
  for (const auto& [text, piece] : mistakes) {
    const std::string said = refusal({"--body-order", text});
    EXPECT_NE(said.find("--body-order: "), std::string::npos) << said;
    EXPECT_NE(said.find(piece), std::string::npos) << said;
  }
}

TEST(BodyOrder, IsNoneOfPartsFromFiles) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "parts", std::ios::binary) << "0\n";
  const ProgramResult result = run_cleave({"run", "--scene", "rock_pile", "--steps", "2", "--partitioner",
                                           "file@path=" + (directory / "parts").string(), "--body-order",
                                           "random", "--out", directory / "out"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(count_lines(result.err), 1) << result.err;
  const std::string& said = result.err;
  EXPECT_NE(said.find("--body-order: random@seed=1"), std::string::npos) << said;
}

}  // namespace
}  // namespace cleave
