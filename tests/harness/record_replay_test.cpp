// cleave record and cleave replay as a user runs them: what a replay says of a step is what the run said.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <thread>

#include "harness/base/hash.h"
#include "harness/base/names.h"
#include "harness/files/problem_file.h"
#include "solver/problem_hash.h"
#include "solver/residual.h"
#include "tests/harness/machine_columns.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
const Arguments kPile = {"--scene", "rock_pile", "--bodies", "20"};

// Runs the program and expects it to end well.
void expect_well(const Arguments& arguments) {
  const ProgramResult result = run_cleave(arguments);
  EXPECT_EQ(result.exit_code, 0) << joined(arguments, " ") << "\n" << result.err;
}

std::vector<std::string> h5_files(const fs::path& directory) {
  std::set<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory))
    if (entry.path().extension() == ".h5") files.insert(entry.path());
  return {files.begin(), files.end()};
}

TEST(Record, WritesOneFileAStep) {
  const TemporaryDirectory directory;
  const fs::path out = directory / "out";
  expect_well(Arguments{"record", "--at", "40,3,25", "--seed", "7", "--out", out} + kPile);
  const Arguments expected = {out / "rock_pile_step000003.h5", out / "rock_pile_step000025.h5",
                              out / "rock_pile_step000040.h5"};
  EXPECT_EQ(h5_files(out), expected);
  const CsvTable table = read_csv(out / "steps.csv");
  ASSERT_EQ(table.rows.size(), 3u);
  for (std::size_t row = 0; row < 3; ++row) {
    const ProblemFile file = read_problem_file(expected[row]);
    EXPECT_EQ(file.scene, "rock_pile");
    EXPECT_EQ(file.seed, 7u);
    EXPECT_EQ(file.friction_model, "box");
    EXPECT_EQ(file.erp, 0.2);
    EXPECT_EQ(file.cfm, 1e-5);
    EXPECT_EQ(file.problem.body_count(), 20);
    EXPECT_EQ(std::to_string(file.step), table.at(row, "step"));
    EXPECT_EQ(hex(problem_hash(file.problem)), table.at(row, "problem_hash"));
    EXPECT_EQ(fs::path(expected[row]).filename(), table.at(row, "problem_file"));
    EXPECT_EQ(table.at(row, "status"), "ok");
  }
  EXPECT_TRUE(fs::exists(out / "manifest.json"));
}

TEST(Record, PhysicsOptionsReachTheFile) {
  const TemporaryDirectory directory;
  expect_well(Arguments{"record", "--at", "30", "--dt", "0.01", "--stiffness", "3e4", "--damping", "100",
                        "--friction", "none", "--out", directory / "out"} +
              kPile);
  const ProblemFile file = read_problem_file(directory / "out/rock_pile_step000030.h5");
  EXPECT_EQ(file.problem.h_s, 0.01);
  EXPECT_DOUBLE_EQ(file.erp, 300.0 / 400);
  EXPECT_DOUBLE_EQ(file.cfm, 1.0 / 400);
  EXPECT_EQ(file.friction_model, "none");
  ASSERT_GT(file.problem.row_count(), 0);
  for (const double compliance : file.problem.compliance) EXPECT_DOUBLE_EQ(compliance, 0.25);
  for (const RowKind kind : file.problem.row_kind) EXPECT_EQ(kind, RowKind::normal);
}

// Only --advance runs: what it does not use is refused, what it uses is taken.
TEST(Record, RefusesOptionsThatItsSolverDoesNotUse) {
  struct Case {
    std::string option, value, used_by, not_used_by;
    Arguments parts = {};  // of used_by
  };
  const std::vector<Case> cases = {{"--partitioner", "mix", "schur", "exact"},
                                   {"--refiner", "fm", "schur", "monolithic"},
                                   {"--max-bodies", "5", "pivot:schur-bodies", "exact"},
                                   {"--tau-mr", "4", "schur", "schur", {"--partitioner", "mr"}},
                                   {"--tau-mix", "0.3", "schur", "schur", {"--partitioner", "mix"}},
                                   {"--max-growth", "0.1", "schur", "schur", {"--refiner", "fm"}},
                                   {"--edge-weight", "pairs", "schur", "schur", {"--refiner", "kl"}},
                                   {"--degree", "constraints", "schur", "exact"},
                                   {"--degree-scope", "whole", "schur", "exact"},
                                   {"--as-printed", "", "schur", "schur", {"--partitioner", "maxdp"}},
                                   {"--skip-small-islands", "", "schur", "exact"},
                                   {"--merge-small", "", "schur", "exact"},
                                   {"--max-iterations", "90", "exact", "pgs"},
                                   {"--reuse-analysis", "", "exact", "ode-quickstep"},
                                   {"--predictor-sweeps", "20", "exact", "interior-point:monolithic"},
                                   {"--sweeps", "300", "pgs", "exact"},
                                   {"--quickstep-iterations", "30", "ode-quickstep", "ode-step"},
                                   {"--ode-step-max-rows", "400", "ode-step", "ode-quickstep"},
                                   {"--ode-friction", "pyramid", "ode-step", "exact"}};
  for (const auto& [option, value, used_by, not_used_by, parts] : cases) {
    SCOPED_TRACE(option);
    const TemporaryDirectory directory;
    Arguments record = {"record", "--scene", "rock_pile", "--bodies", "2", "--at", "1", option};
    if (!value.empty()) record.push_back(value);
    const auto result = [&](const std::string& advance, const std::string& out, const Arguments& more) {
      return run_cleave(record + Arguments{"--advance", advance, "--out", directory / out} + more);
    };
    const ProgramResult taken = result(used_by, "taken", parts);
    EXPECT_EQ(taken.exit_code, 0) << taken.err;
    const ProgramResult refused = result(not_used_by, "refused", {});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_TRUE(refused.err.starts_with("cleave record: " + option + ": ")) << refused.err;
    const bool is_owned = refused.err.find("is a parameter of") != std::string::npos;
    EXPECT_TRUE(is_owned || refused.err.find("--advance " + not_used_by) != std::string::npos) << refused.err;
    EXPECT_EQ(count_lines(refused.err), 1);
    EXPECT_FALSE(fs::exists(directory / "refused"));
  }
}

TEST(Record, SameBytesAgainOnAnyNumberOfThreads) {
  const TemporaryDirectory directory;
  for (const char* threads : {"1", "2"})
    expect_well(Arguments{"record", "--at", "60", "--advance", "schur", "--max-bodies", "5", "--threads",
                          threads, "--out", directory / threads} +
                kPile);
  const std::string name = "rock_pile_step000060.h5";
  EXPECT_TRUE(read_text(directory / "1" / name) == read_text(directory / "2" / name));
}

// Where bodies are and what they look like: the geometry of a box is that of its body, planes point inwards.
TEST(Record, ShapesStandWhereBodiesAre) {
  const TemporaryDirectory directory;
  expect_well(Arguments{"record", "--at", "30", "--out", directory / "out"} + kPile);
  const ProblemFile file = read_problem_file(directory / "out/rock_pile_step000030.h5");
  ASSERT_TRUE(file.shapes);
  const ProblemShapes& shapes = *file.shapes;
  int boxes = 0, planes = 0;
  for (std::size_t g = 0; g < shapes.geom_body.size(); ++g) {
    const int body = shapes.geom_body[g];
    const double* q = &shapes.geom_orientation[4 * g];
    const double normal[3] = {2 * (q[1] * q[3] + q[0] * q[2]), 2 * (q[2] * q[3] - q[0] * q[1]),
                              1 - 2 * (q[1] * q[1] + q[2] * q[2])};
    if (shapes.geom_type[g] == static_cast<std::uint8_t>(GeomType::plane)) {
      ++planes;
      EXPECT_EQ(body, -1);
      for (int i = 0; i < 20; ++i) {  // every rock lies on the free side, or nearly
        double height = 0;
        for (int k = 0; k < 3; ++k)
          height += normal[k] * (file.position[3 * i + k] - shapes.geom_position[3 * g + k]);
        EXPECT_GT(height, 0.1) << "geom " << g << " body " << i;
      }
      continue;
    }
    ++boxes;
    ASSERT_GE(body, 0);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(shapes.geom_position[3 * g + k], file.position[3 * body + k]);
      EXPECT_GE(shapes.geom_size[3 * g + k], 0.5);
      EXPECT_LE(shapes.geom_size[3 * g + k], 0.8);
    }
  }
  EXPECT_EQ(boxes, 20);
  EXPECT_EQ(planes, 5);
}

TEST(Record, EveryKindOfShape) {
  const TemporaryDirectory directory;
  const auto types_of = [&](const Arguments& scene, const std::string& name) {
    const fs::path out = directory / name;
    expect_well(Arguments{"record", "--at", "0", "--out", out} + scene);
    const ProblemShapes shapes = *read_problem_file(h5_files(out).at(0)).shapes;
    std::set<int> types;
    for (std::size_t g = 0; g < shapes.geom_type.size(); ++g) {
      if (shapes.geom_body[g] >= 0) types.insert(shapes.geom_type[g]);
      const bool convex = shapes.geom_type[g] == static_cast<std::uint8_t>(GeomType::convex);
      EXPECT_EQ(shapes.convex_first[g + 1] - shapes.convex_first[g], convex ? 8 : 0);
    }
    return types;
  };
  const auto pile = [](const char* shape) {
    return Arguments{"--scene", "rock_pile", "--bodies", "8", "--rock-shape", shape};
  };
  using Types = std::set<int>;
  EXPECT_EQ(types_of(pile("box"), "a"), Types{0});
  EXPECT_EQ(types_of(pile("sphere"), "b"), Types{1});
  EXPECT_EQ(types_of(pile("clump"), "c"), Types{1});
  EXPECT_EQ(types_of(pile("convex"), "d"), Types{4});
  EXPECT_EQ(types_of({"--scene", "chain_drop", "--links", "5"}, "e"), Types{2});
  const Arguments tower = {"--scene", "log_tower", "--layers", "2"};
  EXPECT_TRUE(types_of(tower + Arguments{"--log-shape", "cylinder"}, "f").contains(3));
}

// Corners of a convex rock lie within half the diagonal of its largest box.
TEST(Record, ConvexCornersAreThoseOfTheRock) {
  const TemporaryDirectory directory;
  expect_well({"record", "--scene", "rock_pile", "--bodies", "8", "--rock-shape", "convex", "--at", "0",
               "--out", directory / "out"});
  const ProblemShapes shapes = *read_problem_file(h5_files(directory / "out").at(0)).shapes;
  ASSERT_EQ(shapes.convex_points.size(), 8u * 8 * 3);
  for (std::size_t i = 0; i < shapes.convex_points.size(); i += 3) {
    const double radius =
        std::hypot(shapes.convex_points[i], shapes.convex_points[i + 1], shapes.convex_points[i + 2]);
    EXPECT_GT(radius, 0.25);
    EXPECT_LT(radius, 0.7);
  }
}

// One run measured at three steps, the same steps recorded, and the recording replayed.
class ReplayOfARun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new TemporaryDirectory;
    const Arguments combinations = {"--partitioner", "mindp,mix",        "--refiner",    "none,fm",
                                    "--solver",      "schur,monolithic", "--max-bodies", "5"};
    expect_well(Arguments{"run", "--steps", "81", "--measure-every", "27", "--out", *directory_ / "run"} +
                kPile + combinations);
    expect_well(Arguments{"record", "--at", "26,53,80", "--out", *directory_ / "recorded"} + kPile);
    expect_well(Arguments{"replay", "--write-solutions", "--out", *directory_ / "replayed"} +
                h5_files(*directory_ / "recorded") + combinations);
  }
  static void TearDownTestSuite() { delete directory_; }
  static CsvTable table(const std::string& name) { return read_csv(*directory_ / name / "steps.csv"); }

  static TemporaryDirectory* directory_;
};
TemporaryDirectory* ReplayOfARun::directory_ = nullptr;

// A file holds the problem and not the world it came from.
const std::set<std::string> kOfTheWorld = {
    "run_id", "contact_cap_hits", "ode_messages", "max_penetration_m", "potential_energy_j", "state_hash",
    "velocity_spread_m_per_s", "problem_file", "joint_drift_m", "last_body_z_m",
    // Options that made the world.
    "mu", "bound_sweeps", "gravity_m_per_s2", "match_tolerance", "contact_cap", "quickstep_iterations",
    "ode_step_max_rows", "ode_friction", "mode", "advance", "steps", "scene_options"};

TEST_F(ReplayOfARun, RowsAreThoseOfTheRun) {
  const CsvTable run = table("run"), replayed = table("replayed");
  ASSERT_EQ(run.rows.size(), 15u);
  ASSERT_EQ(replayed.rows.size(), 15u);
  for (const std::string& column : run.header) {
    if (is_of_the_machine(column) || kOfTheWorld.contains(column)) continue;
    EXPECT_EQ(run.column(column), replayed.column(column)) << column;
  }
}

TEST_F(ReplayOfARun, UnmeasuredColumnsSaySo) {
  const CsvTable replayed = table("replayed");
  const std::set<std::string> unmeasured = {"nan", "-1", "-"};
  for (const std::string& column : kOfTheWorld) {
    if (column == "run_id" || column == "problem_file") continue;
    EXPECT_TRUE(unmeasured.contains(replayed.at(0, column))) << column << " is " << replayed.at(0, column);
  }
  for (const char* column : {"t_collide_ms", "t_extract_ms", "t_predict_ms"})
    EXPECT_EQ(replayed.at(0, column), "nan");
  EXPECT_EQ(replayed.at(0, "problem_file"), (*directory_ / "recorded/rock_pile_step000026.h5").string());
}

TEST_F(ReplayOfARun, CopiesHoldEverySolution) {
  const CsvTable replayed = table("replayed");
  for (const std::string& path : h5_files(*directory_ / "recorded")) {
    const ProblemFile original = read_problem_file(path);
    const ProblemFile copy = read_problem_file(*directory_ / "replayed" / fs::path(path).filename());
    EXPECT_EQ(problem_hash(original.problem), problem_hash(copy.problem));
    EXPECT_EQ(original.position, copy.position);
    EXPECT_TRUE(original.shapes == copy.shapes);
    EXPECT_EQ(copy.solutions.size(), 5u);
    EXPECT_EQ(copy.partitions.size(), 4u);
    EXPECT_FALSE(copy.partitions.contains("-+-+monolithic"));
  }
  for (std::size_t row = 0; row < replayed.rows.size(); ++row) {
    const fs::path path = *directory_ / "replayed" / fs::path(replayed.at(row, "problem_file")).filename();
    const ProblemFile file = read_problem_file(path);
    const std::string label = combination_label(replayed.at(row, "partitioner"), replayed.at(row, "refiner"),
                                                replayed.at(row, "solver"));
    const StoredSolution& solution = file.solutions.at(label);
    EXPECT_EQ(solution.strategy, replayed.at(row, "strategy"));
    EXPECT_EQ(solution.kernel, replayed.at(row, "kernel"));
    std::vector<int> parts;
    if (file.partitions.contains(label)) parts = file.partitions.at(label).part_of_body;
    EXPECT_EQ(hex(solution_hash(solution.impulse, parts)), replayed.at(row, "solution_hash"));
    const ResidualReport verdict = judge(file.problem, solution.impulse);
    EXPECT_TRUE(verdict.exact);
    EXPECT_EQ(verdict.residual_m_per_s, solution.residual_m_per_s);
    EXPECT_EQ(verdict.velocity, solution.velocity);
  }
}

TEST_F(ReplayOfARun, PartitionsRememberTheirOptions) {
  const ProblemFile file = read_problem_file(h5_files(*directory_ / "replayed").back());
  const StoredPartition& partition = file.partitions.at("mix+fm+schur");
  EXPECT_EQ(partition.partitioner, "mix");
  EXPECT_EQ(partition.refiner, "fm");
  std::map<std::string, std::string> stored;
  for (const StoredParameter& parameter : partition.parameters) stored[parameter.name] = parameter.text;
  EXPECT_EQ(stored.at("max_bodies"), "5");
  EXPECT_EQ(stored.at("tau_mix"), "0.5");
  EXPECT_EQ(stored.at("max_growth"), "0.2");
  EXPECT_EQ(stored.at("skip_small_islands"), "false");
}

// --cold is what a file with zeros for its warm start would give, and the row still names the file's problem.
TEST_F(ReplayOfARun, ColdStartsFromZero) {
  const std::string path = h5_files(*directory_ / "recorded").back();
  ProblemFile zeroed = read_problem_file(path);
  const auto replay = [&](const std::string& file, const Arguments& more, const std::string& name) {
    expect_well(
        Arguments{"replay", file, "--solver", "pgs", "--sweeps", "2000", "--out", *directory_ / name} + more);
    return table(name);
  };
  const auto any = [](const std::vector<double>& values) {
    return std::ranges::any_of(values, [](double value) { return value != 0; });
  };
  ASSERT_TRUE(any(zeroed.problem.warm_impulse));
  std::ranges::fill(zeroed.problem.warm_impulse, 0.0);
  write_problem_file(*directory_ / "zeroed.h5", zeroed);
  const CsvTable cold = replay(path, {"--cold"}, "cold");
  const CsvTable of_zeros = replay(*directory_ / "zeroed.h5", {}, "of_zeros");
  EXPECT_EQ(cold.at(0, "solution_hash"), of_zeros.at(0, "solution_hash"));
  EXPECT_EQ(cold.at(0, "problem_hash"), table("replayed").at(14, "problem_hash"));
  EXPECT_NE(cold.at(0, "problem_hash"), of_zeros.at(0, "problem_hash"));
}

TEST_F(ReplayOfARun, FailedCellIsARowAndExitCodeTwo) {
  const ProgramResult result =
      run_cleave(Arguments{"replay", "--solver", "pgs,exact", "--sweeps", "1", "--cold", "--write-solutions",
                           "--out", *directory_ / "failed"} +
                 h5_files(*directory_ / "recorded"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("rock_pile_step000080.h5 step 80 -+- pgs: not_converged"), std::string::npos)
      << result.err;
  const CsvTable failed = table("failed");
  ASSERT_EQ(failed.rows.size(), 6u);
  EXPECT_EQ(failed.at(4, "status"), "not_converged");
  EXPECT_EQ(failed.at(5, "status"), "ok");
  EXPECT_EQ(read_problem_file(h5_files(*directory_ / "failed").back()).solutions.size(), 2u);
}

TEST_F(ReplayOfARun, SolutionsOfEarlierReplaysStay) {
  const std::string path = h5_files(*directory_ / "replayed").back();
  expect_well({"replay", path, "--solver", "exact", "--write-solutions", "--out", *directory_ / "more"});
  const ProblemFile file = read_problem_file(h5_files(*directory_ / "more").back());
  EXPECT_EQ(file.solutions.size(), 6u);
  EXPECT_EQ(file.partitions.size(), 4u);
}

TEST_F(ReplayOfARun, MistakesAreNamedBeforeAnythingIsCreated) {
  const std::string good = h5_files(*directory_ / "recorded").back();
  const std::string copied = h5_files(*directory_ / "replayed").back();
  const std::string out = *directory_ / "never";
  const struct {
    Arguments arguments;
    std::string message;
  } mistakes[] = {
      {{"replay", "--out", out}, "FILES: at least one problem file is required"},
      {{"replay", good}, "--out: is required"},
      {{"replay", good, out + ".h5", "--out", out}, "never.h5: no such file"},
      {{"replay", good, "--solver", "schurr", "--out", out}, "did you mean 'schur'?"},
      {{"replay", good, "--steps", "3", "--out", out}, "--steps: no such option"},
      {{"replay", good, "--mu", "0.3", "--out", out}, "--mu: no such option"},
      {{"replay", good, copied, "--write-solutions", "--out", out}, "another file of this name"},
      {{"replay", good, good, "--out", out}, "FILES: " + good + " is named twice"},
      {{"replay", good, "--out", *directory_ / "run"}, "already holds steps.csv"},
      {{"replay", good, "--write-solutions", "--force", "--out", *directory_ / "recorded"},
       "would replace it"},
      {Arguments{"record", "--out", out} + kPile, "--at: is required"},
      {Arguments{"record", "--at", "5,5", "--out", out} + kPile, "--at: 5 is given twice"},
      {Arguments{"record", "--at", "5,-1", "--out", out} + kPile, "--at: -1 is not in [0, "},
      {Arguments{"record", "--at", "1.5", "--out", out} + kPile, "--at: '1.5' is not a whole number"},
      {Arguments{"record", "--at", "5", "--steps", "9", "--out", out} + kPile, "--steps: no such option"},
      {Arguments{"record", "--at", "5", "--advance", "schur", "--partitioner", "mix,bfs", "--out", out} +
           kPile,
       "--partitioner: 'mix,bfs'"},
      {Arguments{"record", "--at", "5", "--out", *directory_ / "recorded"} + kPile, "already holds"},
  };
  for (const auto& [arguments, message] : mistakes) {
    const ProgramResult result = run_cleave(arguments);
    EXPECT_EQ(result.exit_code, 1) << joined(arguments, " ");
    EXPECT_EQ(count_lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(out)) << joined(arguments, " ");
  }
}

TEST_F(ReplayOfARun, NothingTakesThePlaceOfALinkOrADevice) {
  const std::string good = h5_files(*directory_ / "recorded").back();
  const fs::path link = *directory_ / "link";
  fs::create_symlink(*directory_ / "run" / "steps.csv", link);
  const ProgramResult result = run_cleave({"export", good, "--format", "metis", "--out", link, "--force"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("link is no regular file; name another"), std::string::npos) << result.err;
  EXPECT_TRUE(fs::is_symlink(link));
  fs::remove(link);
}

// A file of the final name is whole whenever the program dies.
TEST(Record, KilledAnywhereLeavesWholeFilesOnly) {
  std::string steps = "0";
  for (int step = 1; step < 400; ++step) steps.append(",").append(std::to_string(step));
  int files = 0, unfinished = 0;
  // Killed when so many files are there, on a machine of any speed.
  for (const std::size_t there : {0, 1, 2, 4, 8, 16, 32}) {
    const TemporaryDirectory directory;
    const fs::path out = directory / "out";
    const pid_t process = start_cleave(Arguments{"record", "--at", steps, "--out", out} + kPile);
    while (there > 0 && (!fs::exists(out) || h5_files(out).size() < there))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ::kill(process, SIGKILL);
    unfinished += finish_cleave(process) == 128 + SIGKILL;
    if (!fs::exists(out)) continue;  // killed before it began
    for (const std::string& file : h5_files(out)) {
      EXPECT_NO_THROW(read_problem_file(file)) << file;
      ++files;
    }
  }
  EXPECT_GT(files, 0);
  EXPECT_GT(unfinished, 0);
}

}  // namespace
}  // namespace cleave
