// The program of a build that found neither METIS nor SCOTCH: it says what to install, and does all else.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/harness/run_program.h"

namespace cleave {
namespace {

ProgramResult run_without(const Arguments& arguments) {
  return run_program(CLEAVE_WITHOUT_LIBRARIES, arguments);
}

// (name, package)
const std::pair<const char*, const char*> kAbsent[] = {
    {"metis-recursive", "libmetis-dev"}, {"metis-kway", "libmetis-dev"}, {"scotch", "libscotch-dev"}};

TEST(WithoutLibraries, are_listed_with_the_package_to_install) {
  const ProgramResult listed = run_without({"list", "partitioners"});
  EXPECT_EQ(listed.exit_code, 0);
  for (const auto& [name, package] : kAbsent) {
    EXPECT_NE(listed.out.find(name), std::string::npos) << listed.out;
    EXPECT_NE(listed.out.find(std::string("install ") + package + " and build again"), std::string::npos)
        << listed.out;
  }
}

TEST(WithoutLibraries, are_refused_by_name_in_one_line) {
  TemporaryDirectory scratch;
  for (const auto& [name, package] : kAbsent) {
    const ProgramResult refused =
        run_without({"run", "--scene", "rock_pile", "--partitioner", name, "--out", scratch / "out"});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_EQ(count_lines(refused.err), 1) << refused.err;
    EXPECT_NE(refused.err.find(package), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
  }
}

// Every other partitioner gives what it gives where they are there.
TEST(WithoutLibraries, are_left_out_of_all_and_nothing_else_changes) {
  TemporaryDirectory scratch;
  const Arguments run = {"run", "--scene",       "rock_pile", "--bodies",  "20",      "--steps",
                         "60",  "--partitioner", "all",       "--refiner", "none,fm", "--measure-every",
                         "20"};
  EXPECT_EQ(run_without(run + Arguments{"--out", scratch / "without"}).exit_code, 0);
  EXPECT_EQ(run_cleave(run + Arguments{"--out", scratch / "with"}).exit_code, 0);
  const CsvTable without = read_csv(scratch / "without" / "steps.csv"),
                 with = read_csv(scratch / "with" / "steps.csv");
  std::size_t row = 0;
  for (std::size_t other = 0; other < with.rows.size(); ++other) {
    const std::string& name = with.at(other, "partitioner");
    if (std::ranges::any_of(kAbsent, [&](const auto& absent) { return absent.first == name; })) continue;
    ASSERT_LT(row, without.rows.size());
    for (const char* column :
         {"step", "partitioner", "refiner", "parts", "interface_rows", "status", "state_hash"})
      EXPECT_EQ(without.at(row, column), with.at(other, column)) << name << " " << column;
    ++row;
  }
  EXPECT_EQ(row, without.rows.size());
  EXPECT_GT(row, 0u);
}

// Of so many boxes METIS's order has fewer operations.
TEST(WithoutLibraries, minimum_degree_orders_what_would_be_dissected) {
  TemporaryDirectory scratch;
  run_cleave({"record", "--scene", "silo", "--bodies", "2000", "--at", "2", "--advance", "pgs@sweeps=30",
              "--out", scratch / "steps"});
  const Arguments replay = {
      "replay", scratch / "steps" / "silo_step000002.h5", "--solver", "exact", "--repeats", "1"};
  EXPECT_EQ(run_without(replay + Arguments{"--out", scratch / "without"}).exit_code, 0);
  EXPECT_EQ(run_cleave(replay + Arguments{"--out", scratch / "with"}).exit_code, 0);
  const CsvTable without = read_csv(scratch / "without" / "steps.csv"),
                 with = read_csv(scratch / "with" / "steps.csv");
  EXPECT_EQ(without.at(0, "status"), "ok");
  const auto mflop = [](const CsvTable& table) { return std::stod(table.at(0, "factor_mflop_local")); };
#ifdef CLEAVE_METIS
  EXPECT_GT(mflop(without), mflop(with));
#else
  EXPECT_EQ(mflop(without), mflop(with));
#endif
}

}  // namespace
}  // namespace cleave
