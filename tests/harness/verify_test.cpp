// cleave verify passes on what replay wrote and finds every change made to it afterwards.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "harness/files/problem_file.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLabel = "mix+fm+schur";

class Verify : public ::testing::Test {
 protected:
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
  // Per file: the problem; 5 solutions with label, residual, velocity; 4 partitions with label, ids, split.
  // Of steps.csv: the limits, and one a row.
  const int checks = 2 * (1 + 5 * 3 + 4 * 3) + 1 + 2 * 5;
  EXPECT_EQ(count_lines(directory.out), checks) << directory.out;
  EXPECT_EQ(directory.out.find("FAIL"), std::string::npos);
  EXPECT_NE(directory.err.find(std::to_string(checks) + " checks, 0 failed"), std::string::npos);

  std::ofstream(out() / "motion.h5") << "a recorded motion is no problem file";
  EXPECT_EQ(count_lines(run_cleave({"verify", out()}).out), checks);
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
    "parts",
    "max_part_bodies",
    "cut_pairs",
    "interface_rows",
    "interface_bodies",
    "interface_cover_bodies",
    "contiguous",
    "part_mass_ratio_max",
    "residual_m_per_s",
    "residual_bilateral_m_per_s",
    "residual_normal_m_per_s",
    "residual_friction_m_per_s",
    "residual_relative",
    "solution_hash",
    "interface_unknowns"  // a schur that works on the whole system has no interface
};

TEST_F(Verify, FindsAChangeOfEveryCellItCompares) {
  const std::string passed = run_cleave({"verify", out()}).out;
  EXPECT_NE(passed.find(": " + std::to_string(kComparedColumns.size() + 1) + " columns\n"), std::string::npos)
      << passed;
  for (const std::string& column : kComparedColumns) {
    fs::copy(*replayed_ / "out/steps.csv", out() / "steps.csv", fs::copy_options::overwrite_existing);
    const std::string value = column.starts_with("residual") ? "1e-10" : "77";
    change_cell(column, value);
    expect_failure(out(), {column + " = " + value});
  }
}

TEST_F(Verify, FindsAnOkAboveTheLimit) {
  change_cell("residual_m_per_s", "1e-6");
  fs::remove(file());  // by the table alone
  expect_failure(out(), {"says ok with a residual of 1e-6 m/s"});
}

// The table of harness/README.md says what each check catches. Each row of it is broken here, and it has as
// many rows as the program has checks.
struct Breakage {
  std::string check;    // first cell of the row
  std::string failure;  // in the line that fails
  std::function<void(ProblemFile&)> change;
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
    {"limit", "says ok with a residual of 1e-6 m/s", nullptr},  // of the table, see below
    {"row", "status = ok, computed anew: a residual above the limit",
     [](ProblemFile& f) { f.solutions.at(kLabel).impulse[4] += 1; }},
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
    if (breakage.change) {
      change_file(breakage.change);
    } else {
      change_cell("residual_m_per_s", "1e-6");
    }
    expect_failure(out(), {breakage.failure});
  }
  EXPECT_EQ(broken, checks_of_readme());

  int calls = 0;
  for (const char* file : {"verify_checks.cpp", "verify_rows.cpp"}) {
    const std::string text = read_text(fs::path(CLEAVE_SOURCE_DIR) / "harness/commands" / file);
    for (std::size_t at = text.find("list.add("); at != std::string::npos;
         at = text.find("list.add(", at + 1))
      ++calls;
  }
  EXPECT_EQ(calls, static_cast<int>(kBreakages.size()));
}

TEST_F(Verify, DamagedInputIsNotAFailedCheck) {
  std::ofstream(out() / "steps.csv", std::ios::app) << "half a line";
  ProgramResult result = run_cleave({"verify", out()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("steps.csv: line 12 has 1 cells"), std::string::npos) << result.err;

  fs::resize_file(file(), fs::file_size(file()) / 2);
  result = run_cleave({"verify", file()});
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
