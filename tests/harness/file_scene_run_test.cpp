// Scene files through the program: the same worlds and problems as compiled scenes, and one line for a bad
// file.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/harness/run_program.h"
#include "tests/scenarios/shipped_scenes.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
CsvTable rows_of(const Arguments& scene, const std::string& steps) {
  const TemporaryDirectory directory;
  Arguments arguments = {"run",      "--partitioner", "mindp",          "--refiner", "fm",
                         "--solver", "schur",         "--repeats",      "1",         "--steps",
                         steps,      "--out",         directory / "out"};
  arguments.insert(arguments.end(), scene.begin(), scene.end());
  const ProgramResult result = run_cleave(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return read_csv(directory / "out/steps.csv");
}

Arguments file(const std::string& name) { return {"--scene", "file@path=" + shipped_file(name)}; }

void expect_same(const std::string& scene, const std::string& steps) {
  const CsvTable written = rows_of(file(scene), steps), compiled = rows_of({"--scene", scene}, steps);
  ASSERT_EQ(compiled.rows.size(), std::stoul(steps));
  for (const char* column :
       {"step", "bodies", "contacts", "rows", "problem_hash", "solution_hash", "state_hash"})
    EXPECT_EQ(written.column(column), compiled.column(column)) << column;
}

TEST(FileSceneRun, ChainDropIsTheCompiledOneStepByStep) { expect_same("chain_drop", "80"); }

// The ball is let go at step 60.
TEST(FileSceneRun, LogTowerIsTheCompiledOneStepByStep) { expect_same("log_tower", "90"); }

TEST(FileSceneRun, TheSeedDecidesAboutThePile) {
  const auto hashes = [](const std::string& seed) {
    Arguments arguments = file("pile");
    arguments.insert(arguments.end(), {"--seed", seed, "--measure-every", "20"});
    return rows_of(arguments, "40").column("state_hash");
  };
  EXPECT_EQ(hashes("3"), hashes("3"));
  EXPECT_NE(hashes("3"), hashes("4"));
}

void expect_refused(const Arguments& scene, const std::string& line) {
  const TemporaryDirectory directory;
  Arguments arguments = {"run", "--out", directory / "out"};
  arguments.insert(arguments.end(), scene.begin(), scene.end());
  const ProgramResult result = run_cleave(arguments);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(count_lines(result.err), 1) << result.err;
  EXPECT_NE(result.err.find(line), std::string::npos) << result.err;
  EXPECT_TRUE(fs::is_empty(directory.path()));
}

TEST(FileSceneRun, ABadFileIsOneLineBeforeAnythingIsCreated) {
  const TemporaryDirectory files;
  const std::string path = files / "bad.toml";
  std::ofstream(path) << "[[body]]\nshape = 'sphere'\nradius_m = -1\n";
  expect_refused({"--scene", "file@path=" + path},
                 path + ":3: body[0].radius_m: -1 is not in [1e-06, 1e+06]");
}

TEST(FileSceneRun, WithoutAPathIsOneLine) {
  expect_refused({"--scene", "file"}, "--scene: file needs path: write file@path=FILE");
}

TEST(FileSceneRun, APathForAnotherSceneIsOneLine) {
  expect_refused({"--scene", "rock_pile@path=" + shipped_file("pile")}, "path is a parameter of scene file");
}

TEST(FileSceneRun, AFileThatIsNotThereIsOneLine) {
  expect_refused({"--scene", "file@path=no/such.toml"}, "--scene file@path: 'no/such.toml' cannot be read");
}

// A run is known by what the file says, not by where it lies.
TEST(FileSceneRun, IdentityIsTheContentNotThePath) {
  const TemporaryDirectory files;
  const std::string text = read_text(shipped_file("pile"));
  std::ofstream(files / "same.toml") << text;
  std::ofstream(files / "other.toml") << text << "# one more line\n";
  const auto names = [](const std::string& path) {
    const CsvTable rows = rows_of({"--scene", "file@path=" + path}, "1");
    EXPECT_EQ(rows.at(0, "scene_options").find("toml"), std::string::npos);
    return std::pair(rows.at(0, "run_id"), rows.at(0, "scene"));
  };
  const auto shipped = names(shipped_file("pile"));
  EXPECT_EQ(names(files / "same.toml"), shipped);
  EXPECT_NE(names(files / "other.toml").first, shipped.first);
  EXPECT_NE(names(files / "other.toml").second, shipped.second);
  EXPECT_TRUE(shipped.second.starts_with("file@")) << shipped.second;
}

}  // namespace
}  // namespace cleave
