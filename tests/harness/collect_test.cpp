// cleave collect and cleave compare on the output directories of real runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numeric>

#include "harness/base/ratio_interval.h"
#include "harness/files/checksums.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

// Replaces the texts that `change` says in every row of a steps.csv.
void edit_rows(const fs::path& path, const std::function<void(CsvTable&)>& change) {
  CsvTable table = read_csv(path);
  change(table);
  std::ofstream file(path, std::ios::binary);
  const auto write = [&file](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) file << (i == 0 ? "" : ",") << cells[i];
    file << "\n";
  };
  write(table.header);
  for (const std::vector<std::string>& row : table.rows) write(row);
}

void set_column(CsvTable& table, const std::string& column, const std::function<std::string(int row)>& text) {
  const auto place = std::ranges::find(table.header, column) - table.header.begin();
  for (std::size_t row = 0; row < table.rows.size(); ++row) table.rows[row][place] = text(row);
}

class Campaigns : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* seed : {"1", "2"})
      ASSERT_EQ(
          run_cleave({"run", "--scene", "rock_pile", "--bodies", "8", "--steps", "24", "--measure-every", "4",
                      "--seed", seed, "--partitioner", "mindp,mix", "--refiner", "none", "--repeats", "1",
                      "--out", directory_.path() / "a" / ("cell" + std::string(seed))})
              .exit_code,
          0);
    for (const char* cell : {"cell1", "cell2"})
      fs::remove(directory_ / "a" / cell / kChecksumsFile);  // rows are changed
    fs::copy(directory_ / "a", directory_ / "b", fs::copy_options::recursive);
    // Times that a test can tell: 10, 11, ... ms.
    for (const char* campaign : {"a", "b"})
      for (const char* cell : {"cell1", "cell2"})
        edit_rows(steps(campaign, cell), [](CsvTable& table) {
          set_column(table, "t_s_ms", [](int row) { return std::to_string(10 + row); });
        });
  }

  fs::path steps(const std::string& campaign, const std::string& cell) const {
    return directory_ / campaign / cell / "steps.csv";
  }
  ProgramResult compare(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"compare", directory_ / "a", directory_ / "b"};
    words.insert(words.end(), more.begin(), more.end());
    return run_cleave(words);
  }

  TemporaryDirectory directory_;
};

TEST_F(Campaigns, AreCollectedIntoOneTable) {
  const ProgramResult result = run_cleave({"collect", directory_ / "a", "--out", directory_ / "all.csv"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const CsvTable table = read_csv(directory_ / "all.csv"), first = read_csv(steps("a", "cell1"));
  ASSERT_EQ(table.rows.size(), 24u);  // 2 cells of 6 steps and 2 combinations
  EXPECT_EQ(table.header.size(), first.header.size() + 2);
  for (std::size_t row = 0; row < first.rows.size(); ++row)
    for (const std::string& column : first.header) EXPECT_EQ(table.at(row, column), first.at(row, column));
  const CsvTable cells = read_csv(directory_ / "all.cells.csv");
  ASSERT_EQ(cells.rows.size(), 2u);
  EXPECT_EQ(cells.at(1, "cell"), table.at(23, "cell"));
  EXPECT_EQ(cells.at(1, "option_seed"), "2");
  EXPECT_EQ(cells.at(1, "rows"), "12");
  EXPECT_EQ(cells.at(1, "run_id"), table.at(23, "run_id"));
  EXPECT_EQ(cells.at(1, "state"), "complete");
  EXPECT_EQ(count_lines(read_text(directory_ / "all.columns.csv")),
            static_cast<int>(table.header.size()) + 1);
  EXPECT_EQ(run_cleave({"collect", directory_ / "a", "--out", directory_ / "all.csv"}).exit_code, 1);
}

TEST_F(Campaigns, CollectedAreVerifiedUnderAnyName) {
  ASSERT_EQ(run_cleave({"collect", directory_ / "a", "--out", directory_ / "table"}).exit_code, 0);
  EXPECT_EQ(count_lines(run_cleave({"verify", directory_ / "table"}).out), 4);
}

// verify knows the tables by their checksums: a byte of any of the four files, a file that is gone, one that
// is none of them.
TEST_F(Campaigns, CollectedAreVerified) {
  const fs::path out = directory_ / "all.csv";
  ASSERT_EQ(run_cleave({"collect", directory_ / "a", "--out", out}).exit_code, 0);
  const ProgramResult good = run_cleave({"verify", out});
  EXPECT_EQ(good.exit_code, 0);
  EXPECT_EQ(count_lines(good.out), 4);
  for (const char* name : {"all.csv", "all.cells.csv", "all.columns.csv", "all.checksums"}) {
    const std::string text = read_text(directory_ / name);
    for (const std::size_t place : {std::size_t{0}, text.size() / 2, text.size() - 1}) {
      std::string flipped = text;
      flipped[place] ^= 1;
      std::ofstream(directory_ / name, std::ios::binary) << flipped;
      EXPECT_EQ(run_cleave({"verify", out}).exit_code, 3) << name << " byte " << place;
    }
    fs::remove(directory_ / name);
    EXPECT_EQ(run_cleave({"verify", out}).exit_code, 3) << name;
    std::ofstream(directory_ / name, std::ios::binary) << text;
  }
  const std::string sums = read_text(directory_ / "all.checksums");
  std::ofstream(directory_ / "all.checksums", std::ios::app) << sums.substr(0, 64) << "  other.csv\n";
  EXPECT_NE(run_cleave({"verify", out}).out.find("it names other files than the three tables"),
            std::string::npos);
}

TEST_F(Campaigns, WhatWasNotWrittenWholeIsLeftOutAndSaid) {
  const std::string text = read_text(steps("a", "cell2"));
  std::ofstream(steps("a", "cell2"), std::ios::binary) << text.substr(0, text.size() - 5);
  const ProgramResult result = run_cleave({"collect", directory_ / "a", "--out", directory_ / "all.csv"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("23 rows of 2 output directories, 1 of them incomplete"), std::string::npos)
      << result.err;
}

TEST_F(Campaigns, OfOtherColumnsAreRefusedByName) {
  edit_rows(steps("a", "cell2"), [](CsvTable& table) { table.header.back() = "other"; });
  const ProgramResult result = run_cleave({"collect", directory_ / "a", "--out", directory_ / "all.csv"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("cell2/steps.csv: its columns are not those of"), std::string::npos)
      << result.err;
  EXPECT_FALSE(fs::exists(directory_ / "all.csv"));
}

// A table of the same schema from before the last columns came.
TEST_F(Campaigns, WithoutTheLastColumnsAreTakenWithoutTheirValues) {
  const fs::path path = steps("a", "cell2");
  const std::size_t columns = read_csv(path).header.size();
  edit_rows(path, [](CsvTable& table) {
    table.header.pop_back();
    for (std::vector<std::string>& row : table.rows) row.pop_back();
  });
  const ProgramResult result = run_cleave({"collect", directory_ / "a", "--out", directory_ / "all.csv"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const CsvTable table = read_csv(directory_ / "all.csv");
  ASSERT_EQ(table.header.size(), columns + 2);
  EXPECT_EQ(table.at(23, "core_round_trip_ns"), "nan");
  EXPECT_EQ(compare().exit_code, 0);
  edit_rows(path, [](CsvTable& table) {
    set_column(table, "schema_version", [](int) { return "cleave-steps-4"; });
  });
  const ProgramResult refused = compare();
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("cell2/steps.csv: line 2: its columns are not those of"), std::string::npos)
      << refused.err;
}

TEST_F(Campaigns, ChangedAfterTheRunAreRefused) {
  for (const char* cell : {"cell1", "cell2"})
    write_checksums(directory_ / "b" / cell, {"manifest.json", "steps.csv"});
  ASSERT_EQ(compare().exit_code, 0);
  edit_rows(steps("b", "cell2"),
            [](CsvTable& table) { set_column(table, "t_s_ms", [](int) { return "-5"; }); });
  const ProgramResult compared = compare();
  EXPECT_EQ(compared.exit_code, 1);
  EXPECT_NE(compared.err.find("cell2/steps.csv: is not what the run wrote"), std::string::npos)
      << compared.err;
  EXPECT_EQ(compared.out, "");
  EXPECT_EQ(run_cleave({"collect", directory_ / "b", "--out", directory_ / "all.csv"}).exit_code, 1);
  EXPECT_FALSE(fs::exists(directory_ / "all.csv"));
}

TEST_F(Campaigns, WithALineOfOtherCellsAreRefusedByLine) {
  const std::size_t columns = read_csv(steps("b", "cell1")).header.size();
  for (const int more : {-40, -1, 1}) {
    const std::size_t cells = columns + more;
    edit_rows(steps("b", "cell1"), [&](CsvTable& table) { table.rows[3].resize(cells, "7"); });
    const std::string wanted = "b/cell1/steps.csv: line 5 has " + std::to_string(cells) +
                               " cells, allowed: " + std::to_string(columns) + "\n";
    const ProgramResult compared = compare();
    EXPECT_EQ(compared.exit_code, 1);
    EXPECT_NE(compared.err.find(wanted), std::string::npos) << compared.err;
    EXPECT_EQ(compared.out, "");
    const ProgramResult collected =
        run_cleave({"collect", directory_ / "b", "--out", directory_ / "all.csv"});
    EXPECT_EQ(collected.exit_code, 1);
    EXPECT_NE(collected.err.find(wanted), std::string::npos) << collected.err;
    EXPECT_FALSE(fs::exists(directory_ / "all.csv"));
  }
}

TEST_F(Campaigns, WithACellThatIsNoNumberAreRefusedByIt) {
  for (const std::string text : {"abc", "12x", "", "-"}) {
    edit_rows(steps("b", "cell1"), [&](CsvTable& table) {
      set_column(table, "t_s_ms", [&](int row) { return row == 3 ? text : "10"; });
    });
    const ProgramResult result = compare();
    EXPECT_EQ(result.exit_code, 1) << text;
    EXPECT_NE(result.err.find("b/cell1/steps.csv: line 5: t_s_ms = '" + text + "', allowed: a number\n"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(result.out, "");
  }
}

// -1 is "not measured" in a column of integers alone.
TEST_F(Campaigns, MinusOneIsAValueOfAColumnOfNumbers) {
  const auto steps_of = [&](const std::string& column) {
    for (const char* campaign : {"a", "b"})
      for (const char* cell : {"cell1", "cell2"})
        edit_rows(steps(campaign, cell), [&](CsvTable& table) {
          set_column(table, column, [](int row) { return row < 4 ? "-1" : "5"; });
        });
    return parse_csv(compare({"--column", column}).out).column("steps");
  };
  EXPECT_EQ(steps_of("potential_energy_j"), std::vector<std::string>(4, "6"));
  EXPECT_EQ(steps_of("factorizations"), std::vector<std::string>(4, "4"));
}

TEST_F(Campaigns, ThatAreTheSameCompareAsSuch) {
  const ProgramResult result = compare();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const CsvTable table = parse_csv(result.out);
  ASSERT_EQ(table.rows.size(), 4u);
  for (std::size_t row = 0; row < 4; ++row) {
    EXPECT_EQ(table.at(row, "verdict"), "same");
    EXPECT_EQ(table.at(row, "ratio"), "1");
    EXPECT_EQ(table.at(row, "steps"), "6");
  }
}

TEST_F(Campaigns, SlowerAndFasterGroupsAreToldAndSlowerOnesFail) {
  const auto scale = [&](const std::string& cell, double factor) {
    edit_rows(steps("b", cell), [factor](CsvTable& table) {
      set_column(table, "t_s_ms", [&](int row) { return std::to_string(factor * (10 + row)); });
    });
  };
  scale("cell1", 0.5);
  EXPECT_EQ(compare().exit_code, 0);
  scale("cell2", 1.2);
  const ProgramResult result = compare();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("2 regressions"), std::string::npos) << result.err;
  const std::vector<std::string> verdicts = parse_csv(result.out).column("verdict");
  EXPECT_EQ(std::ranges::count(verdicts, "slower"), 2);
  EXPECT_EQ(std::ranges::count(verdicts, "faster"), 2);
  EXPECT_EQ(compare({"--allow", "0.3"}).exit_code, 0);
}

TEST_F(Campaigns, AStepThatWasSolvedAndIsNoMoreFails) {
  edit_rows(steps("b", "cell1"), [](CsvTable& table) {
    set_column(table, "status", [](int row) { return row == 4 ? "not_converged" : "ok"; });
  });
  const ProgramResult result = compare();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.out.find(",5,1,0,"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(",lost\n"), std::string::npos) << result.out;
}

// As on a cluster of two kinds of nodes: rounds of a cell here and there.
TEST_F(Campaigns, OfTwoProcessorsAreKeptApart) {
  const auto set_machine = [&](const std::string& campaign, const std::string& cell) {
    const fs::path path = directory_ / campaign / cell / "manifest.json";
    std::string text = read_text(path);
    const std::size_t from = text.find(": \"", text.find("\"cpu_model\"")) + 3;
    text.replace(from, text.find('"', from) - from, "Another");
    std::ofstream(path) << text;
  };
  fs::copy(directory_ / "a/cell1", directory_ / "a/round2", fs::copy_options::recursive);
  EXPECT_EQ(compare().exit_code, 0);
  set_machine("a", "round2");
  const ProgramResult refused = compare();
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("was measured on '"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("Another"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("add machine to --by"), std::string::npos) << refused.err;
  EXPECT_EQ(compare({"--column", "interface_rows"}).exit_code, 0);  // equal on every processor
  const ProgramResult apart = compare({"--by", "run_id,partitioner,machine"});
  EXPECT_EQ(apart.exit_code, 0) << apart.err;
  EXPECT_NE(apart.err.find("4 groups in both, 2 in A alone"), std::string::npos) << apart.err;

  fs::remove_all(directory_ / "a/round2");
  set_machine("b",
              "cell1");  // two campaigns on two machines may be held against each other, and that is said
  const ProgramResult other = compare();
  EXPECT_EQ(other.exit_code, 0) << other.err;
  EXPECT_NE(other.err.find("2 groups on another processor in B"), std::string::npos) << other.err;

  ASSERT_EQ(run_cleave({"collect", directory_ / "b", "--out", directory_ / "all.csv"}).exit_code, 0);
  const CsvTable table = read_csv(directory_ / "all.csv");
  EXPECT_EQ(table.at(0, "machine"), "Another");
  EXPECT_NE(table.at(23, "machine"), "Another");
}

TEST_F(Campaigns, WithoutACommonGroupPrintNoTable) {
  edit_rows(steps("b", "cell1"),
            [](CsvTable& table) { set_column(table, "partitioner", [](int) { return "other"; }); });
  fs::remove_all(steps("b", "cell2").parent_path());
  const ProgramResult result = compare({"--by", "partitioner"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_NE(result.err.find("--by: no group of partitioner is in both"), std::string::npos) << result.err;
}

// What was there before stays, all three of it; nothing new is left.
TEST_F(Campaigns, AreCollectedIntoAllTablesOrNone) {
  const fs::path folder = directory_ / "tables";
  fs::create_directories(folder / "all.csv");
  for (const char* name : {"all.cells.csv", "all.columns.csv"}) std::ofstream(folder / name) << "earlier";
  const ProgramResult result =
      run_cleave({"collect", directory_ / "a", "--out", folder / "all.csv", "--force"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("all.csv is no regular file"), std::string::npos) << result.err;
  for (const char* name : {"all.cells.csv", "all.columns.csv"})
    EXPECT_EQ(read_text(folder / name), "earlier");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 3);
}

TEST_F(Campaigns, AFileOfARunIsVerifiedWithItsDirectory) {
  for (const char* name : {"steps.csv", "manifest.json"})
    EXPECT_EQ(run_cleave({"verify", directory_ / "a/cell1" / name}).out,
              run_cleave({"verify", directory_ / "a/cell1"}).out);
}

TEST_F(Campaigns, ATableOfTheNameOfARunsIsVerifiedAsATable) {
  const fs::path out = directory_ / "steps.csv";
  ASSERT_EQ(run_cleave({"collect", directory_ / "a", "--out", out}).exit_code, 0);
  EXPECT_EQ(count_lines(run_cleave({"verify", out}).out), 4);
}

TEST_F(Campaigns, AreNotReplacedByTheirTable) {
  const std::string rows = read_text(steps("a", "cell1"));
  for (const fs::path& out : {steps("a", "cell1"), directory_ / "a/cell2/../cell1/steps.csv"}) {
    const ProgramResult result = run_cleave({"collect", directory_ / "a", "--out", out, "--force"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("cell1/steps.csv, which is read; name another file"), std::string::npos)
        << result.err;
  }
  EXPECT_EQ(read_text(steps("a", "cell1")), rows);
}

TEST_F(Campaigns, WithANameThatIsTooLongAreRefusedByIt) {
  const std::string name(300, 'x');
  const ProgramResult result = run_cleave({"collect", directory_ / "a", "--out", directory_ / name});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find(": cannot be written: File name too long"), std::string::npos) << result.err;
}

TEST_F(Campaigns, AreComparedByOtherColumnsAndNames) {
  const ProgramResult result = compare({"--by", "partitioner", "--column", "interface_rows"});
  EXPECT_EQ(parse_csv(result.out).column("partitioner"), (std::vector<std::string>{"mindp", "mix"}));
  EXPECT_NE(compare({"--by", "partitionr"}).err.find("did you mean 'partitioner'?"), std::string::npos);
  EXPECT_NE(compare({"--by", "step,partitioner,step"}).err.find("--by: step is given twice"),
            std::string::npos);
  EXPECT_NE(compare({"--column", "status"}).err.find("holds text"), std::string::npos);
  EXPECT_NE(compare({"--allow", "-1"}).err.find("--allow: -1 is not in"), std::string::npos);
  EXPECT_EQ(run_cleave({"compare", directory_ / "a"}).exit_code, 1);
  EXPECT_EQ(run_cleave({"collect", directory_.path() / "none", "--out", directory_ / "x.csv"}).exit_code, 1);
}

TEST(RatioInterval, HoldsTheRatioAndIsOfItsPairs) {
  std::vector<double> a(40), b(40);
  std::iota(a.begin(), a.end(), 100.0);
  for (std::size_t i = 0; i < a.size(); ++i) b[i] = 1.1 * a[i];
  const RatioInterval exact = ratio_interval(a, b, 1);  // what both have in common drops out
  EXPECT_NEAR(exact.ratio, 1.1, 1e-12);
  EXPECT_NEAR(exact.high - exact.low, 0, 1e-12);
  for (std::size_t i = 0; i < a.size(); ++i) b[i] = a[i] * (i % 2 == 0 ? 0.5 : 2);
  const RatioInterval wide = ratio_interval(a, b, 1);
  EXPECT_LT(wide.low, 0.9);
  EXPECT_GT(wide.high, 1.1);
  EXPECT_LE(wide.low, wide.ratio);
  EXPECT_GE(wide.high, wide.ratio);
}

// An even number, by hand; four pairs are too few.
TEST(RatioInterval, IsOfMedians) {
  const std::vector<double> a = {1, 2, 3, 100}, b = {4, 7, 1, 1000};
  const RatioInterval few = ratio_interval(a, b, 1);
  EXPECT_DOUBLE_EQ(few.ratio, 5.5 / 2.5);  // 2 and 7 / 3 of the lower and the upper middle
  EXPECT_TRUE(std::isnan(few.low) && std::isnan(few.high));
}

// Where half of the pairs are 0, so are both medians of some resamples.
TEST(RatioInterval, IsNoneWhereResamplesHaveNoRatio) {
  const std::vector<double> a = {0, 0, 0, 1, 2, 3, 4};
  const RatioInterval interval = ratio_interval(a, a, 1);
  EXPECT_EQ(interval.ratio, 1);
  EXPECT_TRUE(std::isnan(interval.low) && std::isnan(interval.high));
}

}  // namespace
}  // namespace cleave
