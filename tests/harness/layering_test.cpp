// Which folder may include what: partitioners and solvers are plain data in, plain data out, and stay so.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace cleave {
namespace {

namespace fs = std::filesystem;

struct Include {
  fs::path file;     // relative to the source tree
  std::string name;  // between the quotes or brackets
  bool local;        // in quotes
};

std::vector<Include> includes_of_file(const fs::path& file) {
  static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> found;
  std::ifstream text(file);
  for (std::string line; std::getline(text, line);) {
    std::smatch match;
    if (std::regex_search(line, match, pattern))
      found.push_back({fs::relative(file, CLEAVE_SOURCE_DIR), match[2], match[1] == "\""});
  }
  return found;
}

std::vector<fs::path> sources(const std::string& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(fs::path(CLEAVE_SOURCE_DIR) / folder))
    if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::vector<Include> includes_of_folder(const std::string& folder) {
  std::vector<Include> all;
  for (const fs::path& file : sources(folder)) {
    const std::vector<Include> some = includes_of_file(file);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

bool begins_with_any(const std::string& name, const std::vector<std::string>& prefixes) {
  return std::ranges::any_of(prefixes, [&](const std::string& prefix) { return name.starts_with(prefix); });
}

// The standard library's own headers have neither a dot nor a slash in their name.
bool is_standard(const Include& include) {
  return !include.local && include.name.find_first_of("./") == std::string::npos;
}

void expect_local_only_from(const std::string& folder, const std::vector<std::string>& prefixes) {
  const std::vector<Include> all = includes_of_folder(folder);
  ASSERT_FALSE(all.empty()) << folder;
  for (const Include& include : all) {
    if (!include.local) continue;
    EXPECT_TRUE(begins_with_any(include.name, prefixes)) << include.file << " includes " << include.name;
  }
}

TEST(Layering, PartitionKnowsTheStandardLibraryAndItself) {
  expect_local_only_from("partition", {"partition/"});
  for (const Include& include : includes_of_folder("partition")) {
    // An adapter to a graph library is one file of its own, named after it.
    const bool adapter = begins_with_any(include.file.filename().string(), {"metis", "scotch"});
    EXPECT_TRUE(include.local || adapter || is_standard(include))
        << include.file << " includes " << include.name;
  }
}

TEST(Layering, SolverKnowsNeitherOdeNorTheOtherRooms) {
  expect_local_only_from("solver", {"solver/"});
  for (const Include& include : includes_of_folder("solver"))
    EXPECT_FALSE(begins_with_any(include.name, {"ode/", "hdf5", "CLI/"}))
        << include.file << " includes " << include.name;
}

// Scene files are read by toml++, and nothing else is.
TEST(Layering, ScenariosKnowOdeOnly) {
  expect_local_only_from("scenarios", {"scenarios/", "harness/base/"});
  for (const Include& include : includes_of_folder("scenarios"))
    EXPECT_TRUE(include.local || is_standard(include) || include.name.starts_with("ode/") ||
                (include.name.starts_with("toml++/") && include.file.filename().string().starts_with("file_")))
        << include.file << " includes " << include.name;
}

TEST(Layering, HarnessNeverIncludesTests) {
  expect_local_only_from("harness",
                         {"partition/", "solver/", "scenarios/", "harness/", "cleave_build_info.h"});
}

// The judge vouches for solvers, so it shares nothing with them but the problem.
TEST(Layering, JudgeKnowsTheProblemOnly) {
  for (const char* file : {"solver/residual.cpp", "solver/residual.h"}) {
    const std::vector<Include> all = includes_of_file(fs::path(CLEAVE_SOURCE_DIR) / file);
    ASSERT_FALSE(all.empty()) << file;
    for (const Include& include : all) {
      const bool allowed = include.name == "solver/residual.h" || include.name == "solver/step_problem.h";
      EXPECT_TRUE(!include.local || allowed) << file << " includes " << include.name;
    }
  }
}

// ODE's joints are read in one place; the other files that know ODE own the world.
TEST(Layering, OdeHeadersStayWhereTheyBelong) {
  const std::vector<std::string> allowed = {"ode_world",  "ode_baselines", "joint_rows",
                                            "body_terms", "extract",       "build_info"};
  for (const Include& include : includes_of_folder("harness")) {
    if (!include.name.starts_with("ode/")) continue;
    EXPECT_TRUE(begins_with_any(include.file.filename().string(), allowed))
        << include.file << " includes " << include.name;
  }
}

// The checker itself: it must see what it forbids.
TEST(Layering, ReaderSeesBothFormsOfInclude) {
  const fs::path file =
      fs::temp_directory_path() / ("cleave_layering_" + std::to_string(::getpid()) + ".cpp");
  std::ofstream(file) << "#include <ode/ode.h>\n  #  include \"partition/grow.h\"\n// #include "
                         "<metis.h>\n#include <vector>\n";
  const std::vector<Include> found = includes_of_file(file);
  fs::remove(file);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].name, "ode/ode.h");
  EXPECT_FALSE(is_standard(found[0]));
  EXPECT_TRUE(found[1].local);
  EXPECT_TRUE(is_standard(found[2]));
}

}  // namespace
}  // namespace cleave
