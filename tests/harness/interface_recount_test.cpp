// What steps.csv says of the interface, counted again from the recorded problem and the stored parts: a Schur
// solver that quietly worked on the whole system, or on other parts than it names, is found.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "harness/files/problem_file.h"
#include "partition/registry.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

// Of one step and its parts, from row_body and part_of_body alone.
struct Recount {
  int parts = 0;
  int largest_part = 0;
  int cut_rows = 0;
  std::set<std::pair<int, int>> cut_pairs;
  std::set<int> cut_bodies;
  int matching = 0;  // disjoint cut pairs, taken greedily: every vertex cover has at least one body of each
};

Recount recount(const StepProblem& problem, const std::vector<int>& part_of_body) {
  Recount count;
  const std::set<int> ids(part_of_body.begin(), part_of_body.end());
  count.parts = static_cast<int>(ids.size());
  for (const int id : ids)
    count.largest_part = std::max(count.largest_part, static_cast<int>(std::ranges::count(part_of_body, id)));
  std::set<int> matched;
  for (int r = 0; r < problem.row_count(); ++r) {
    const auto [a, b] = std::minmax(problem.row_body[2 * r], problem.row_body[2 * r + 1]);
    if (a < 0 || part_of_body[a] == part_of_body[b]) continue;
    ++count.cut_rows;
    count.cut_bodies.insert({a, b});
    if (!count.cut_pairs.insert({a, b}).second || matched.contains(a) || matched.contains(b)) continue;
    matched.insert({a, b});
    ++count.matching;
  }
  return count;
}

class InterfaceRecount : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new TemporaryDirectory;
    std::vector<std::string> files;
    for (const auto& [scene, size] :
         {std::pair{"rock_pile", "--bodies"}, std::pair{"chain_drop", "--links"}}) {
      const fs::path out = *directory_ / scene;
      ASSERT_EQ(run_cleave({"record", "--scene", scene, size, "36", "--at", "90", "--out", out}).exit_code,
                0);
      files.push_back(out / (std::string(scene) + "_step000090.h5"));
    }
    const ProgramResult result =
        run_cleave({"replay", files[0], files[1], "--partitioner", "all", "--refiner", "all", "--solver",
                    "schur,auto:schur-rows,interior-point:schur-bodies,monolithic", "--max-bodies", "6",
                    "--repeats", "1", "--write-solutions", "--out", *directory_ / "out"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  static void TearDownTestSuite() { delete directory_; }

  static TemporaryDirectory* directory_;
};
TemporaryDirectory* InterfaceRecount::directory_ = nullptr;

TEST_F(InterfaceRecount, EveryRowOfTheTableAgreesWithItsFile) {
  const CsvTable table = read_csv(*directory_ / "out/steps.csv");
  // Without file, which needs a path, and semantic, which needs groups.
  ASSERT_EQ(table.rows.size(), 2 * ((partitioners().size() - 2) * refiners().size() * 3 + 1));
  std::map<std::string, ProblemFile> files;
  for (const auto& entry : fs::directory_iterator(*directory_ / "out"))
    if (entry.path().extension() == ".h5")
      files.emplace(entry.path().filename(), read_problem_file(entry.path()));
  int rows_with_interface = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto number = [&](const char* column) { return std::stoi(table.at(row, column)); };
    const std::string label =
        combination_label(table.at(row, "partitioner"), table.at(row, "refiner"), table.at(row, "solver"));
    SCOPED_TRACE(table.at(row, "scene") + " " + label);
    const ProblemFile& file = files.at(fs::path(table.at(row, "problem_file")).filename());
    EXPECT_EQ(number("rows"), file.problem.row_count());
    if (table.at(row, "solver") == "monolithic") {
      EXPECT_EQ(number("interface_unknowns"), 0);
      EXPECT_FALSE(file.partitions.contains(label));
      continue;
    }
    const Recount count = recount(file.problem, file.partitions.at(label).part_of_body);
    EXPECT_EQ(number("parts"), count.parts);
    EXPECT_EQ(number("max_part_bodies"), count.largest_part);
    EXPECT_EQ(number("interface_rows"), count.cut_rows);
    EXPECT_EQ(number("cut_pairs"), static_cast<int>(count.cut_pairs.size()));
    EXPECT_EQ(number("interface_bodies"), static_cast<int>(count.cut_bodies.size()));
    EXPECT_LE(number("interface_cover_bodies"), number("interface_bodies"));
    if (table.at(row, "kernel") == "schur-rows") {
      EXPECT_EQ(number("interface_unknowns"), count.cut_rows);
    } else {
      EXPECT_EQ(table.at(row, "kernel"), "schur-bodies");
      EXPECT_EQ(number("interface_unknowns") % 6, 0);
      EXPECT_GE(number("interface_unknowns"), 6 * count.matching);
      EXPECT_LE(number("interface_unknowns"), 6 * static_cast<int>(count.cut_bodies.size()));
    }
    EXPECT_EQ(std::stod(table.at(row, "factor_mflop_interface")) > 0, count.cut_rows > 0);
    rows_with_interface += count.cut_rows > 0;
  }
  EXPECT_GE(rows_with_interface, 80);
}

}  // namespace
}  // namespace cleave
