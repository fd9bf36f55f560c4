// The page about problem files: its program writes a file that the commands accept, in as few lines as it
// says.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "harness/files/problem_file.h"
#include "harness/files/problem_file_fields.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

const std::string kPage = std::string(CLEAVE_SOURCE_DIR) + "/harness/files/PROBLEM_FILES.md";
const std::string kPython = "/usr/bin/python3";

// What stands between ```python and ```.
std::string program_of_page() {
  const std::string page = read_text(kPage), fence = "```python\n";
  const std::size_t begin = page.find(fence);
  if (begin == std::string::npos) return "";
  const std::size_t from = begin + fence.size();
  return page.substr(from, page.find("```", from) - from);
}

TEST(ProblemPage, ItsWriterMakesAFileThatReplayAndVerifyAccept) {
  const std::string program = program_of_page();
  EXPECT_GT(count_lines(program), 20);
  EXPECT_LE(count_lines(program), 30);
  const TemporaryDirectory directory;
  std::ofstream(directory / "write.py") << program;
  const ProgramResult written = run_program(kPython, {directory / "write.py", directory / "balls.h5"});
  ASSERT_EQ(written.exit_code, 0) << written.err;

  const ProgramResult replayed =
      run_cleave({"replay", directory / "balls.h5", "--partitioner", "mix", "--refiner", "fm", "--max-bodies",
                  "1", "--solver", "schur,exact", "--write-solutions", "--out", directory / "out"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  const CsvTable table = read_csv(directory / "out" / "steps.csv");
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.column("status"), std::vector<std::string>(2, "ok"));
  EXPECT_EQ(table.column("contacts"), std::vector<std::string>(2, "2"));
  EXPECT_EQ(table.column("rows_friction"), std::vector<std::string>(2, "4"));
  EXPECT_EQ(table.column("friction"), std::vector<std::string>(2, "-"));
  const ProgramResult verified = run_cleave({"verify", directory / "out"});
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;

  // The balls stay on the ground.
  const ProblemFile file = read_problem_file(directory / "out" / "balls.h5");
  ASSERT_EQ(file.solutions.size(), 2u);
  for (const auto& [label, solution] : file.solutions)
    for (const int body : {0, 1}) EXPECT_LT(std::abs(solution.velocity[6 * body + 2]), 1e-5) << label;
}

TEST(ProblemPage, NamesEverythingThatAFileHolds) {
  const std::string page = read_text(kPage);
  ProblemFile file;
  int names = 0;
  const auto look = [&](const std::string& name, Presence presence) {
    const std::size_t optional_part = page.find("## The rest: optional");
    const std::size_t at = page.find("`" + name + "`");
    ASSERT_NE(at, std::string::npos) << name;
    // Friction arrays stand with the problem: they may be left out only where there is no friction.
    const bool among_required =
        presence == Presence::required || name.starts_with("friction_row") || name == "friction_coefficient";
    EXPECT_TRUE(!among_required || at < optional_part) << name;
    ++names;
  };
  visit_attributes(file, [&](const char* name, auto&, Presence presence) { look(name, presence); });
  visit_arrays(file, 0, 0,
               [&](const char* name, auto&, const Hdf5Shape&, Presence presence) { look(name, presence); });
  look("contact_set", Presence::optional);
  EXPECT_GE(names, 20);
}

}  // namespace
}  // namespace cleave
