// cleave verify passes on what replay wrote and finds every change made to it afterwards.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "harness/files/checksums.h"
#include "harness/files/problem_file.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLabel = "mix+fm+schur";

class Verify : public ::testing::Test {
 public:
  static void SetUpTestSuite() {
    replayed_ = new TemporaryDirectory;
    const fs::path recorded = *replayed_ / "recorded";
    ASSERT_EQ(
        run_cleave({"record", "--scene", "rock_pile", "--bodies", "20", "--at", "60,80", "--out", recorded})
            .exit_code,
        0);
    ASSERT_EQ(
        run_cleave({"replay", recorded / "rock_pile_step000060.h5", recorded / "rock_pile_step000080.h5",
                    "--partitioner", "mindp,mix", "--refiner", "none,fm", "--solver", "schur,exact",
                    "--max-bodies", "5", "--repeats", "1", "--write-solutions", "--out", *replayed_ / "out"})
            .exit_code,
        0);
  }
  static void TearDownTestSuite() { delete replayed_; }

  // A fresh copy of the output directory for each test to spoil.
  void SetUp() override { fs::copy(*replayed_ / "out", out()); }
  fs::path out() const { return copy_ / "out"; }
  fs::path file() const { return out() / "rock_pile_step000080.h5"; }

  void change_file(const std::function<void(ProblemFile&)>& change) const {
    ProblemFile content = read_problem_file(file());
    change(content);
    write_problem_file(file(), content);
    rewrite_checksums();
  }

  // Someone who knows of the checksums changes them too: what is left are the checks of the content.
  void rewrite_checksums() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(out()))
      names.push_back(entry.path().filename());
    std::ranges::sort(names);
    write_checksums(out(), names);
  }

  void write_text(const std::string& name, const std::string& text) const {
    std::ofstream(out() / name, std::ios::binary) << text;
    rewrite_checksums();
  }

  // The lines of steps.csv, without their ends; 0 is the header.
  void change_lines(const std::function<void(std::vector<std::string>&)>& change) const {
    std::istringstream csv(read_text(out() / "steps.csv"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(csv, line);) lines.push_back(line);
    change(lines);
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    write_text("steps.csv", text);
  }

  void change_manifest(const std::string& from, const std::string& to) const {
    std::string text = read_text(out() / "manifest.json");
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write_text("manifest.json", text.replace(at, from.size(), to));
  }

  // Replaces one cell of the row of kLabel at step 80.
  void change_cell(const std::string& column, const std::string& value) const {
    const CsvTable table = read_csv(out() / "steps.csv");
    std::ofstream csv(out() / "steps.csv", std::ios::binary);
    const auto line = [&csv](const std::vector<std::string>& cells) {
      for (std::size_t i = 0; i < cells.size(); ++i) csv << (i == 0 ? "" : ",") << cells[i];
      csv << "\n";
    };
    line(table.header);
    int changed = 0;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      std::vector<std::string> cells = table.rows[row];
      const bool chosen = table.at(row, "step") == "80" && table.at(row, "partitioner") == "mix" &&
                          table.at(row, "refiner") == "fm";
      for (std::size_t i = 0; i < cells.size(); ++i) {
        if (!chosen || table.header[i] != column) continue;
        EXPECT_NE(cells[i], value);
        cells[i] = value;
        ++changed;
      }
      line(cells);
    }
    EXPECT_EQ(changed, 1) << column;
    csv.close();
    rewrite_checksums();
  }

  // Exit code 3, and each text in a line that begins with FAIL.
  void expect_failure(const fs::path& path, const std::vector<std::string>& texts) const {
    const ProgramResult result = run_cleave({"verify", path});
    EXPECT_EQ(result.exit_code, 3) << result.out << result.err;
    std::string failed;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("FAIL")) failed += line + "\n";
    for (const std::string& text : texts)
      EXPECT_NE(failed.find(text), std::string::npos) << text << " in\n" << failed;
  }

  static TemporaryDirectory* replayed_;
  TemporaryDirectory copy_;
};
TemporaryDirectory* Verify::replayed_ = nullptr;

TEST_F(Verify, PassesOnWhatReplayWrote) {
  const ProgramResult directory = run_cleave({"verify", out()});
  EXPECT_EQ(directory.exit_code, 0) << directory.out << directory.err;
  // Of the directory: its list of files, four files, no others; the manifest, its state and run id. Per file:
  // the problem; 5 solutions with label, residual, velocity; 4 partitions with label, ids, split. Of
  // steps.csv: header, cells, limits, sums, options twice, places, problems, counts, and two a row.
  const int checks = 6 + 3 + 2 * (1 + 5 * 3 + 4 * 3) + 9 + 2 * 2 * 5;
  EXPECT_EQ(count_lines(directory.out), checks) << directory.out;
  EXPECT_EQ(directory.out.find("FAIL"), std::string::npos);
  EXPECT_NE(directory.err.find(std::to_string(checks) + " checks, 0 failed"), std::string::npos);

  const ProgramResult alone = run_cleave({"verify", file(), *replayed_ / "recorded"});
  EXPECT_EQ(alone.exit_code, 0) << alone.out;
}

TEST_F(Verify, FindsAChangedImpulse) {
  change_file([](ProblemFile& f) { f.solutions.at(kLabel).impulse[4] += 1e-6; });
  expect_failure(file(), {std::string("solution/") + kLabel + ": residual", "velocity is v0"});
  expect_failure(out(), {"residual", "velocity", "solution_hash"});
}

// Too small for any residual to show; the fingerprint does.
TEST_F(Verify, FindsTheLastBitOfAnImpulse) {
  change_file([](ProblemFile& f) {
    double& impulse = f.solutions.at(kLabel).impulse[4];
    impulse = std::nextafter(impulse, 1e9);
  });
  expect_failure(out(), {"solution_hash"});
}

TEST_F(Verify, FindsAChangedVelocity) {
  change_file([](ProblemFile& f) { f.solutions.at(kLabel).velocity[7] += 1e-6; });
  expect_failure(file(), {"velocity is v0"});
}

TEST_F(Verify, FindsAFlatteredResidual) {
  change_file([](ProblemFile& f) { f.solutions.at(kLabel).residual_m_per_s = 1e-4; });
  expect_failure(file(), {"residual"});
}

TEST_F(Verify, FindsImpulsesThatAreNoNumbers) {
  change_file([](ProblemFile& f) { f.solutions.at(kLabel).impulse[0] = std::nan(""); });
  expect_failure(file(), {"residual nan"});
}

TEST_F(Verify, FindsWrongLabels) {
  change_file([](ProblemFile& f) {
    f.solutions["mindp+kl+schur"] = f.solutions.at(kLabel);
    f.partitions["mindp+kl+schur"] = f.partitions.at(kLabel);
  });
  expect_failure(file(), {"solution/mindp+kl+schur: label", "partition/mindp+kl+schur: label"});
}

TEST_F(Verify, FindsPartIdsOutOfRange) {
  change_file([](ProblemFile& f) { f.partitions.at(kLabel).part_of_body[3] = 20; });
  expect_failure(file(), {"part_of_body[3] = 20, allowed: 0 to 19"});
  change_file([](ProblemFile& f) { f.partitions.at(kLabel).part_of_body[3] = -1; });
  expect_failure(out(), {"part_of_body[3] = -1"});
}

// Still a partition, but not that of these algorithms and options.
TEST_F(Verify, FindsABodyInAnotherPart) {
  change_file([](ProblemFile& f) {
    std::vector<int>& parts = f.partitions.at(kLabel).part_of_body;
    parts[3] = parts[3] == 0 ? 1 : 0;
  });
  expect_failure(file(), {"split again, 1 bodies differ"});
  expect_failure(out(), {"solution_hash"});
}

void set_parameter(StoredPartition& partition, const std::string& name, const std::string& text) {
  for (StoredParameter& parameter : partition.parameters)
    if (parameter.name == name) parameter.text = text;
}

TEST_F(Verify, FindsAnOptionThatDidNotShapeTheParts) {
  change_file([](ProblemFile& f) { set_parameter(f.partitions.at(kLabel), "max_bodies", "3"); });
  expect_failure(file(), {"bodies differ"});
}

// What cannot be split again was not checked, and says so.
TEST_F(Verify, FindsAPartitionerThatIsNone) {
  change_file([](ProblemFile& f) {
    StoredPartition misspelt = f.partitions.at(kLabel);
    misspelt.partitioner = "mindq";
    f.partitions["mindq+fm"] = misspelt;
  });
  expect_failure(file(),
                 {"cannot be split again: --partitioner: 'mindq' is unknown (did you mean 'mindp'?)"});
}

TEST_F(Verify, FindsAParameterOutsideItsRangeOrMissing) {
  change_file([](ProblemFile& f) { set_parameter(f.partitions.at(kLabel), "max_bodies", "0"); });
  expect_failure(file(), {"cannot be split again: --max-bodies: 0 is not in [1, inf)"});
  change_file([](ProblemFile& f) {
    std::erase_if(f.partitions.at(kLabel).parameters, [](const auto& p) { return p.name == "max_bodies"; });
  });
  expect_failure(file(), {"cannot be split again: max_bodies is missing"});
}

TEST_F(Verify, FindsAProblemThatIsNotTheRows) {
  change_file([](ProblemFile& f) { f.problem.rhs[0] += 1e-3; });
  expect_failure(out(), {"problem_hash"});
}

TEST_F(Verify, FindsAModelThatIsNotThatOfTheContacts) {
  change_file([](ProblemFile& f) { f.friction_model = "cone"; });
  expect_failure(out(), {"friction_model cone; contact_set[", "] = 0, allowed: 1"});
}

// All columns that a row is compared in but `status`, which only the file's impulses can contradict.
const std::vector<std::string> kComparedColumns = {
    "scene",
    "seed",
    "step",
    "friction",
    "bodies",
    "contacts",
    "rows",
    "rows_bilateral",
    "rows_normal",
    "rows_friction",
    "islands",
    "problem_hash",
    "dt_s",
    "cfm",
    "erp",
    "time_s",
    "parts",
    "max_part_bodies",
    "cut_pairs",
    "interface_rows",
    "interface_bodies",
    "interface_cover_bodies",
    "contiguous",
    "part_mass_ratio_max",
    "parts_before",
    "max_part_bodies_before",
    "cut_pairs_before",
    "interface_rows_before",
    "interface_bodies_before",
    "contiguous_before",
    "partition_origin",
    "residual_m_per_s",
    "residual_bilateral_m_per_s",
    "residual_normal_m_per_s",
    "residual_friction_m_per_s",
    "residual_relative",
    "largest_free_velocity_m_per_s",
    "kinetic_energy_j",
    "energy_excess_j",
    "bound_mismatch",
    "friction_beyond_share",
    "part_condition_max",
    "strategy",
    "kernel",
    "auto_choice",
    "solution_hash",
    "interface_unknowns"  // a schur that works on the whole system has no interface
};
// Beside them: status twice, and that the file holds solution and partition.
constexpr std::size_t kOtherComparisons = 4;

TEST_F(Verify, FindsAChangeOfEveryCellItCompares) {
  const std::string passed = run_cleave({"verify", out()}).out;
  EXPECT_NE(passed.find(": " + std::to_string(kComparedColumns.size() + kOtherComparisons) + " columns\n"),
            std::string::npos)
      << passed;
  for (const std::string& column : kComparedColumns) {
    fs::copy(*replayed_ / "out/steps.csv", out() / "steps.csv", fs::copy_options::overwrite_existing);
    const std::string value = column.starts_with("residual") ? "1e-10" : "77";
    change_cell(column, value);
    expect_failure(out(), {column + " = " + value});
  }
}

// What the manifest's options decide, and what a row of a replay cannot know.
TEST_F(Verify, FindsAChangeOfEveryCellOfTheOptions) {
  const std::vector<std::pair<std::string, std::string>> changes = {{"run_id", "0123456789abcdef"},
                                                                    {"threads", "7"},
                                                                    {"repeat_count", "2"},
                                                                    {"max_bodies", "6"},
                                                                    {"edge_weight", "pairs"},
                                                                    {"tau_mix", "0.25"},
                                                                    {"max_growth", "0.5"},
                                                                    {"as_printed", "1"},
                                                                    {"skip_small_islands", "1"},
                                                                    {"merge_small", "1"},
                                                                    {"cold", "1"},
                                                                    {"session", "1"},
                                                                    {"repartition", "on-change"},
                                                                    {"mode", "lockstep"},
                                                                    {"steps", "3"},
                                                                    {"schema_version", "other"},
                                                                    {"contact_cap", "9"},
                                                                    {"gravity_m_per_s2", "9.81"},
                                                                    {"state_hash", "0"},
                                                                    {"t_collide_ms", "1"},
                                                                    {"last_body_z_m", "2"}};
  for (const auto& [column, value] : changes) {
    fs::copy(*replayed_ / "out/steps.csv", out() / "steps.csv", fs::copy_options::overwrite_existing);
    change_cell(column, value);
    expect_failure(out(), {column + " = " + value + ", by the manifest"});
  }
}

TEST_F(Verify, FindsAChangedStatusAndItsReason) {
  change_cell("status", "not_converged");
  expect_failure(out(), {"status = not_converged, allowed: ok, as the residual is within the limit"});
  fs::copy(*replayed_ / "out/steps.csv", out() / "steps.csv", fs::copy_options::overwrite_existing);
  change_cell("status", "refused");
  expect_failure(out(), {"status = refused, computed anew: a solution", "t_s_ms"});
  fs::copy(*replayed_ / "out/steps.csv", out() / "steps.csv", fs::copy_options::overwrite_existing);
  change_cell("status", "fine");
  expect_failure(out(), {"status = fine, allowed: ok, not_converged"});
  fs::copy(*replayed_ / "out/steps.csv", out() / "steps.csv", fs::copy_options::overwrite_existing);
  change_cell("status_reason", "none at all");
  expect_failure(out(), {"status_reason = none at all, allowed: - where status is ok"});
}

TEST_F(Verify, FindsCountsOfTheModelThatCannotBe) {
  for (const char* column :
       {"model_rows_left_out", "model_rows_at_rest", "model_rows_returned", "model_passes"}) {
    fs::copy(*replayed_ / "out/steps.csv", out() / "steps.csv", fs::copy_options::overwrite_existing);
    change_cell(column, "2");
    expect_failure(out(), {std::string(column) + " = 2, allowed: "});
  }
  fs::copy(*replayed_ / "out/steps.csv", out() / "steps.csv", fs::copy_options::overwrite_existing);
  change_cell("model", "auto");
  expect_failure(out(), {"model = auto, by the manifest"});
}

// Times cannot be computed again, but they add up.
TEST_F(Verify, FindsTimesThatDoNotAddUp) {
  for (const char* column : {"t_s_ms", "t_s_analyze_ms", "t_s_check_ms", "t_s_other_ms"}) {
    fs::copy(*replayed_ / "out/steps.csv", out() / "steps.csv", fs::copy_options::overwrite_existing);
    change_cell(column, "0.123456");
    expect_failure(out(), {"t_s_other_ms = "});
  }
  for (const char* column : {"t_s_min_ms", "t_s_max_ms", "t_pr_ms"}) {
    fs::copy(*replayed_ / "out/steps.csv", out() / "steps.csv", fs::copy_options::overwrite_existing);
    change_cell(column, "0.123456");
    expect_failure(out(), {std::string(column) + " = 0.123456"});
  }
}

TEST_F(Verify, NamesRowsThatAreTooManyMissingOrOutOfOrder) {
  change_lines([](auto& lines) { lines.erase(lines.begin() + 3); });
  expect_failure(out(), {"rock_pile_step000060.h5 mix+none+schur has no row"});
  change_lines([](auto& lines) { lines.insert(lines.begin() + 3, lines[2]); });
  expect_failure(out(), {"line 4: ", "repeats line 3"});
  fs::copy(*replayed_ / "out/steps.csv", out() / "steps.csv", fs::copy_options::overwrite_existing);
  change_lines([](auto& lines) { std::swap(lines[2], lines[4]); });
  expect_failure(out(), {"stands out of order"});
}

TEST_F(Verify, FindsATableThatHoldsNothingOrSwappedColumns) {
  write_text("steps.csv", "x\n");
  expect_failure(out(), {"steps.csv: header and lines of its schema; column 1 is x, allowed: run_id"});
  fs::copy(*replayed_ / "out/steps.csv", out() / "steps.csv", fs::copy_options::overwrite_existing);
  change_lines([](auto& lines) {
    for (std::string& line : lines) {
      const std::size_t comma = line.find(','), second = line.find(',', comma + 1);
      line = line.substr(comma + 1, second - comma) + line.substr(0, comma) + line.substr(second);
    }
  });
  expect_failure(out(), {"column 1 is scene, allowed: run_id"});
}

TEST_F(Verify, FindsMissingProblemFilesAndSolutions) {
  fs::remove(file());
  expect_failure(out(), {"rock_pile_step000080.h5: sha256 no such file"});
  rewrite_checksums();
  // The file that was replayed has the problem still, but no solutions.
  expect_failure(out(), {"solution = mix+fm+schur, computed anew: none in the file"});
  fs::rename(*replayed_ / "recorded", *replayed_ / "away");
  expect_failure(out(), {"steps.csv line 7: problem file", "rock_pile_step000080.h5 is not there"});
  fs::rename(*replayed_ / "away", *replayed_ / "recorded");
}

TEST_F(Verify, FindsDeletedSolutionsAndPartitions) {
  change_file([](ProblemFile& f) { f.solutions.erase(kLabel); });
  expect_failure(out(), {"solution = mix+fm+schur, computed anew: none in the file"});
  change_file([](ProblemFile& f) { f.partitions.erase(kLabel); });
  expect_failure(out(), {"partition = mix+fm+schur, computed anew: none in the file"});
}

TEST_F(Verify, NamesEveryDamagedMissingOrOtherFile) {
  for (const char* name : {"steps.csv", "manifest.json", "rock_pile_step000060.h5"}) {
    std::fstream bytes(out() / name, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(40);
    bytes.put('\0');
    bytes.close();
    expect_failure(out(), {std::string(name) + ": sha256 "});
    fs::copy(*replayed_ / "out" / name, out() / name, fs::copy_options::overwrite_existing);
  }
  std::ofstream(out() / "motion.h5") << "of another run";
  expect_failure(out(), {"motion.h5 is not of this run"});
  fs::remove(out() / "motion.h5");
  fs::remove(out() / "checksums");
  expect_failure(out(), {"checksums: cannot be read"});
}

// Not mistaken for an older program's.
TEST_F(Verify, FindsAManifestThatNoLongerSaysItsFilesOrItsSchema) {
  for (const char* member : {"files", "steps_schema"}) {
    fs::copy(*replayed_ / "out/manifest.json", out() / "manifest.json", fs::copy_options::overwrite_existing);
    change_manifest(std::string("  \"") + member + "\": ", "  \"other\": ");
    expect_failure(out(), {std::string("manifest.json: readable; it has no ") + member});
  }
}

// sha256sum of coreutils reads the same file.
TEST_F(Verify, ChecksumsAreThoseOfSha256sum) {
  EXPECT_EQ(run_program("/bin/sh", {"-c", "cd " + out().string() + " && sha256sum --strict -c checksums"})
                .exit_code,
            0);
}

TEST_F(Verify, ReportsARunThatDidNotEnd) {
  for (const char* state : {"running", "interrupted", "failed"}) {
    fs::copy(*replayed_ / "out/manifest.json", out() / "manifest.json", fs::copy_options::overwrite_existing);
    change_manifest("\"complete\"", std::string("\"") + state + "\"");
    expect_failure(out(), {std::string("state ") + state + "; incomplete"});
    fs::remove(out() / "checksums");
    expect_failure(out(), {std::string("state ") + state + "; incomplete"});
  }
}

// Directories of older programs have no checksums and name no files: that is said, and the rest is checked.
TEST_F(Verify, SaysWhatCannotBeCheckedOfAnOlderDirectory) {
  const fs::path stored = fs::path(CLEAVE_SOURCE_DIR) / "tests/harness/golden/older_run";
  const ProgramResult result = run_cleave({"verify", stored});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_NE(result.err.find("of a program without checksums"), std::string::npos) << result.err;
}

TEST_F(Verify, FindsAnOkAboveTheLimit) {
  change_cell("residual_m_per_s", "1e-6");
  expect_failure(out(), {"says ok with a residual of 1e-6 m/s"});
}

// The table of harness/README.md says what each check catches. Each row of it is broken here, and it has as
// many rows as the program has checks.
struct Breakage {
  std::string check;    // first cell of the row
  std::string failure;  // in the line that fails
  std::function<void(ProblemFile&)> change;
  std::function<void(const Verify&)> spoil = nullptr;  // where it is not the problem file that is broken
};

const std::vector<Breakage> kBreakages = {
    {"friction model", "friction_model bax; --friction: 'bax' is unknown",
     [](ProblemFile& f) { f.friction_model = "bax"; }},
    {"label of a solution", "solution/mindp+kl+schur: label",
     [](ProblemFile& f) { f.solutions["mindp+kl+schur"] = f.solutions.at(kLabel); }},
    {"residual", "m/s, stored", [](ProblemFile& f) { f.solutions.at(kLabel).residual_m_per_s = 1e-4; }},
    {"velocity", "velocity is v0", [](ProblemFile& f) { f.solutions.at(kLabel).velocity[7] += 1e-6; }},
    {"label of a partition", "partition/mindp+kl+schur: label",
     [](ProblemFile& f) { f.partitions["mindp+kl+schur"] = f.partitions.at(kLabel); }},
    {"part ids", "part_of_body[3] = 20",
     [](ProblemFile& f) { f.partitions.at(kLabel).part_of_body[3] = 20; }},
    {"parts taken over", "partition_origin = made up, allowed: fresh, repaired, kept",
     [](ProblemFile& f) {
       f.partitions.at(kLabel).parameters.push_back({"partition_origin", Parameter::Kind::word, "made up"});
     }},
    {"can be split again", "cannot be split again: --partitioner: 'mindq'",
     [](ProblemFile& f) { f.partitions.at(kLabel).partitioner = "mindq"; }},
    {"split again", "split again, 1 bodies differ",
     [](ProblemFile& f) {
       int& part = f.partitions.at(kLabel).part_of_body[3];
       part = part == 0 ? 1 : 0;
     }},
    {"parts from files", "from files, refiner fn; --refiner: 'fn' is unknown",
     [](ProblemFile& f) {
       f.partitions.at(kLabel).partitioner = "file@0123456789abcdef";
       f.partitions.at(kLabel).refiner = "fn";
     }},
    {"fingerprint of a file", "part ids have the fingerprint",
     [](ProblemFile& f) {
       f.partitions.at(kLabel).partitioner = "file@0123456789abcdef";
       f.partitions.at(kLabel).refiner = "none";
     }},
    {"row", "status = ok, computed anew: a residual above the limit",
     [](ProblemFile& f) { f.solutions.at(kLabel).impulse[4] += 1; }},
    {"list of files", "checksums: readable; ", nullptr,
     [](const Verify& v) { std::ofstream(v.out() / "checksums", std::ios::app) << "half a line"; }},
    {"checksum", "steps.csv: sha256", nullptr,
     [](const Verify& v) { std::ofstream(v.out() / "steps.csv", std::ios::app) << "\n"; }},
    {"other files", "motion.h5 is not of this run", nullptr,
     [](const Verify& v) { std::ofstream(v.out() / "motion.h5") << "of another run"; }},
    {"manifest", "manifest.json: readable; ", nullptr,
     [](const Verify& v) { v.change_manifest("\"columns\"", "\"columnx\""); }},
    {"state", "state running; incomplete: it was killed", nullptr,
     [](const Verify& v) { v.change_manifest("\"complete\"", "\"running\""); }},
    {"run id", "its options give", nullptr,
     [](const Verify& v) { v.change_manifest("\"max-bodies\": 5", "\"max-bodies\": 6"); }},
    {"header", "column 1 is x, allowed: run_id", nullptr,
     [](const Verify& v) { v.write_text("steps.csv", "x\n"); }},
    {"cells", "line 10: bodies = 'many', allowed: a number", nullptr,
     [](const Verify& v) { v.change_cell("bodies", "many"); }},
    {"limit", "says ok with a residual of 1e-6 m/s", nullptr,
     [](const Verify& v) { v.change_cell("residual_m_per_s", "1e-6"); }},
    {"sums", "line 10: t_s_other_ms = 7", nullptr,
     [](const Verify& v) { v.change_cell("t_s_other_ms", "7"); }},
    {"options", "options of a run; --partitioner: 'mindq' is unknown", nullptr,
     [](const Verify& v) {
       v.change_manifest("\"partitioner\": \"mindp,mix\"", "\"partitioner\": \"mindq,mix\"");
     }},
    {"places", "has no row", nullptr,
     [](const Verify& v) { v.change_lines([](auto& lines) { lines.pop_back(); }); }},
    {"options in rows", "line 10: threads = 7, by the manifest", nullptr,
     [](const Verify& v) { v.change_cell("threads", "7"); }},
    {"rows of a problem", "bodies = 7, in line 7 20, of the same problem", nullptr,
     [](const Verify& v) { v.change_cell("bodies", "7"); }},
    {"counts", "rows_ok = 9, counted from the rows: 10", nullptr,
     [](const Verify& v) { v.change_manifest("\"rows_ok\": 10", "\"rows_ok\": 9"); }},
    {"problem file", "is not there", nullptr,
     [](const Verify& v) { v.change_cell("problem_file", "elsewhere.h5"); }},
};

std::vector<std::string> checks_of_readme() {
  std::istringstream readme(read_text(fs::path(CLEAVE_SOURCE_DIR) / "harness/README.md"));
  std::vector<std::string> names;
  bool inside = false;
  for (std::string line; std::getline(readme, line);) {
    if (line.starts_with("| check |")) {
      inside = true;
    } else if (!line.starts_with("|")) {
      inside = false;
    } else if (inside && !line.starts_with("|---")) {
      names.push_back(line.substr(2, line.find(" |", 2) - 2));
    }
  }
  return names;
}

TEST_F(Verify, EveryCheckOfTheTableCanFail) {
  std::vector<std::string> broken;
  for (const Breakage& breakage : kBreakages) {
    SCOPED_TRACE(breakage.check);
    broken.push_back(breakage.check);
    fs::copy(*replayed_ / "out", out(), fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    fs::remove(out() / "motion.h5");
    if (breakage.change) change_file(breakage.change);
    if (breakage.spoil) breakage.spoil(*this);
    expect_failure(out(), {breakage.failure});
  }
  EXPECT_EQ(broken, checks_of_readme());

  int calls = 0;
  for (const char* file : {"verify_problem_file.cpp", "verify_directory.cpp", "verify_rows.cpp",
                           "verify_row_sums.cpp", "verify_row_groups.cpp", "verify_file_rows.cpp"}) {
    const std::string text = read_text(fs::path(CLEAVE_SOURCE_DIR) / "harness/commands" / file);
    for (std::size_t at = text.find("list.add("); at != std::string::npos;
         at = text.find("list.add(", at + 1))
      ++calls;
  }
  EXPECT_EQ(calls, static_cast<int>(kBreakages.size()));
}

TEST_F(Verify, FindsHalfALine) {
  std::ofstream(out() / "steps.csv", std::ios::app) << "half a line";
  rewrite_checksums();
  expect_failure(out(), {"steps.csv: line 12 has 1 cells"});
}

TEST_F(Verify, DamagedInputIsNotAFailedCheck) {
  fs::resize_file(file(), fs::file_size(file()) / 2);
  ProgramResult result = run_cleave({"verify", file()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("truncated or damaged"), std::string::npos) << result.err;

  fs::create_directory(copy_ / "empty");
  result = run_cleave({"verify", copy_ / "empty"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("holds neither problem files (.h5) nor steps.csv"), std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace cleave
