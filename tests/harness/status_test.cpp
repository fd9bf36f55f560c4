// Which statuses there are and who gives them: one that nothing gives is documented as reserved, and a name
// that nobody needs does not stay.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "solver/step_solver.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
using Files = std::set<std::string>;

// By status, the sources that give it to a solve or a row. Comparisons do not count.
const std::map<std::string, Files> kGivers = {
    {"ok",
     {"solver/step_solver.h", "harness/campaign/cell_result.cpp", "harness/experiment/combination.h",
      "harness/peers/peer_process.h"}},
    {"not_converged",
     {"solver/direct_solver.cpp", "solver/baselines/iterative_baseline.cpp", "solver/baselines/lemke.cpp",
      "harness/campaign/cell_result.cpp", "harness/experiment/combination.cpp",
      "harness/peers/peer_solver.cpp"}},
    {"timeout", {"harness/campaign/cell_result.cpp", "harness/peers/peer_process.cpp"}},
    {"out_of_memory",
     {"solver/baselines/lemke.cpp", "solver/direct_solver.cpp", "harness/campaign/cell_result.cpp",
      "harness/experiment/combination.cpp", "harness/peers/peer_process.cpp"}},
    {"diverged",
     {"solver/direct_solver.cpp", "harness/campaign/cell_result.cpp", "harness/experiment/combination.cpp",
      "harness/peers/peer_solver.cpp"}},
    {"refused",
     {"solver/step_solver.cpp", "solver/baselines/lemke.cpp", "harness/world/ode_baselines.cpp",
      "harness/campaign/cell_result.cpp", "harness/experiment/chosen_kernel.cpp",
      "harness/experiment/combination.cpp", "harness/peers/peer_solver.cpp"}},
    {"crashed",
     {"harness/campaign/cell_result.cpp", "harness/world/ode_baselines.cpp",
      "harness/peers/peer_process.cpp"}},
    {"skipped", {"harness/experiment/step_record.h"}},
};

// status = SolveStatus::refused, unsolved(problem, SolveStatus::refused, ...), status = "skipped".
std::map<std::string, Files> find_givers() {
  static const std::regex pattern(R"((?:[^=!<>]=\s*|problem, )SolveStatus::(\w+)|status = \"(\w+)\")");
  std::map<std::string, Files> givers;
  for (const char* folder : {"harness", "partition", "scenarios", "solver"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(CLEAVE_SOURCE_DIR) / folder)) {
      const fs::path& path = entry.path();
      if (path.extension() != ".h" && path.extension() != ".cpp") continue;
      const std::string text = read_text(path);
      for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
        givers[(*match)[1].str() + (*match)[2].str()].insert(fs::relative(path, CLEAVE_SOURCE_DIR));
    }
  return givers;
}

TEST(Statuses, EachIsGivenByWhomTheTableSays) {
  std::map<std::string, Files> found = find_givers();
  EXPECT_GE(found.size(), 6u);
  for (const auto& [status, files] : kGivers) EXPECT_EQ(found[status], files) << status;
}

TEST(Statuses, TheTableNamesAll) {
  std::set<std::string> listed;
  for (const auto& [status, files] : kGivers) listed.insert(status);
  const std::vector<std::string> names = status_names();
  EXPECT_EQ(listed, Files(names.begin(), names.end()));
}

TEST(Statuses, AreFoundByTheirNames) {
  for (const std::string& name : status_names()) {
    ASSERT_TRUE(find_status(name)) << name;
    EXPECT_EQ(to_string(*find_status(name)), name);
  }
  EXPECT_EQ(find_status("fine"), std::nullopt);
}

TEST(Statuses, AllAreDocumentedAndReservedWhereNothingGivesThem) {
  const std::string solver = read_text(fs::path(CLEAVE_SOURCE_DIR) / "solver/README.md");
  const std::string schema = read_text(fs::path(CLEAVE_SOURCE_DIR) / "results/README.md");
  for (const auto& [status, files] : kGivers) {
    const bool nobody = files.empty();
    EXPECT_EQ(solver.find("`" + status + "` is reserved") != std::string::npos, nobody) << status;
    EXPECT_EQ(schema.find("`" + status + "` is reserved") != std::string::npos, nobody) << status;
    EXPECT_NE(schema.find("`" + status + "`"), std::string::npos) << status;
  }
}

}  // namespace
}  // namespace cleave
