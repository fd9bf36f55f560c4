// Partitioner auto, --objective and --calibration as a user gives them.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "harness/commands/stored_partition.h"
#include "harness/experiment/algorithms.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

const Arguments kPile = {"run",     "--scene", "rock_pile",       "--bodies", "40",       "--repeats", "1",
                         "--steps", "60",      "--measure-every", "20",       "--solver", "schur"};

CsvTable rows_of(const Arguments& more, const std::filesystem::path& out) {
  const ProgramResult result = run_cleave(kPile + more + Arguments{"--out", out});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const ProgramResult verified = run_cleave({"verify", out});
  EXPECT_EQ(verified.exit_code, 0) << verified.out;
  return read_csv(out / "steps.csv");
}

bool is_fingerprint(const std::string& text) {
  return text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

TEST(CostOptions, RowsOfAutoSayWhatItChoseAndByWhat) {
  const TemporaryDirectory directory;
  const Arguments split = {"--partitioner", "auto,mindp",    "--refiner",
                           "none",          "--cost-kernel", "schur-bodies"};
  const CsvTable one = rows_of(split, directory / "one"), two = rows_of(split, directory / "two");
  ASSERT_EQ(one.rows.size(), 6u);
  for (std::size_t row = 0; row < one.rows.size(); ++row) {
    const bool is_auto = one.at(row, "partitioner") == "auto";
    EXPECT_EQ(one.at(row, "auto_choice").ends_with("/schur-bodies"), is_auto) << one.at(row, "auto_choice");
    EXPECT_EQ(is_fingerprint(one.at(row, "calibration")), is_auto) << one.at(row, "calibration");
    EXPECT_EQ(one.at(row, "cost_threads"), is_auto ? "1" : "-");
  }
  for (const char* column : {"auto_choice", "run_id", "solution_hash", "parts"})
    EXPECT_EQ(one.column(column), two.column(column)) << column;
}

// A calibration by which a part costs and nothing else.
TEST(CostOptions, AnotherCalibrationIsAnotherRunAndAnotherChoice) {
  const TemporaryDirectory directory;
  const std::string file = directory / "own.toml";
  std::ofstream(file)
      << "schema = \"cleave-calibration-4\"\n\n[schur-rows.threads-1]\nfactorizations_constant = 0\n"
         "factorizations_per_fixed_row = 0\nfactorizations_per_log_body = 0\nfactorizations_per_degree = "
         "0\nfactorizations_per_mass_spread = "
         "0\nfactorizations_most = 1\n"
         "active_share_constant = 0\nactive_share_per_log_degree = 0\nactive_share_per_constraint = "
         "0\nus_per_solve = 0\nns_per_row = "
         "0\nns_per_row_prepared = 0\nns_per_block = "
         "0\nus_per_part = 1\n"
         "ns_per_row_and_pass = 0\nns_per_local_block = 0\nns_per_local_flop = 0\n"
         "ns_per_forming_flop = 0\nns_per_interface_flop = 0\nns_per_entry = 0\nns_per_body = 0\n";
  const Arguments split = {"--partitioner", "auto", "--refiner", "none"};
  const CsvTable shipped = rows_of(split, directory / "shipped");
  const Arguments own = kPile + split + Arguments{"--calibration", file, "--out", directory / "own"};
  ASSERT_EQ(run_cleave(own).exit_code, 0);
  const CsvTable rows = read_csv(directory / "own/steps.csv");
  EXPECT_NE(rows.at(0, "run_id"), shipped.at(0, "run_id"));
  EXPECT_NE(rows.at(0, "calibration"), shipped.at(0, "calibration"));
  EXPECT_EQ(rows.at(0, "auto_choice"), "single+none/schur-rows");
  EXPECT_EQ(rows.at(0, "parts"), "1");

  // In the partitioner's own text it is known by what is in the file too, wherever that lies.
  const std::string fingerprint = rows.at(0, "calibration"), copy = directory / "copy.toml";
  std::filesystem::copy_file(file, copy);
  const auto named = [&](const std::string& path, const std::string& out) {
    return rows_of({"--partitioner", "auto@calibration=" + path, "--refiner", "none"}, directory / out);
  };
  const CsvTable first = named(file, "first");
  EXPECT_EQ(first.at(0, "partitioner"), "auto@calibration=" + fingerprint);
  EXPECT_EQ(first.at(0, "calibration"), fingerprint);
  EXPECT_EQ(named(copy, "second").column("run_id"), first.column("run_id"));
  const Arguments again = {"run", "--config", directory / "first/manifest.json", "--out",
                           directory / "again"};
  const ProgramResult unnamed = run_cleave(again);
  EXPECT_EQ(unnamed.exit_code, 1);
  EXPECT_NE(unnamed.err.find(fingerprint + " is not the shipped one"), std::string::npos) << unnamed.err;
  EXPECT_EQ(run_cleave(again + Arguments{"--partitioner", "auto@calibration=" + file}).exit_code, 0);
  EXPECT_EQ(read_csv(directory / "again/steps.csv").column("run_id"), first.column("run_id"));
  std::ofstream(copy, std::ios::app) << "\n";
  EXPECT_NE(named(copy, "third").column("run_id"), first.column("run_id"));
}

// Two sources are the fewest: one to fit, one to hold out.
TEST(CostOptions, CalibrateWritesWhatRunsRead) {
  const TemporaryDirectory directory;
  const Arguments record = {"record", "--scene", "rock_pile", "--bodies", "20", "--at", "60,80", "--out"};
  ASSERT_EQ(run_cleave(record + Arguments{directory / "made"}).exit_code, 0);
  const std::string one = directory / "made/rock_pile_step000060.h5",
                    two = directory / "made/rock_pile_step000080.h5", out = directory / "own.toml";
  const ProgramResult alone = run_cleave({"calibrate", one, "--out", out, "--repeats", "1"});
  EXPECT_EQ(alone.exit_code, 1);
  EXPECT_NE(alone.err.find("none to hold out; name more FILES"), std::string::npos) << alone.err;
  EXPECT_FALSE(std::filesystem::exists(out));
  ASSERT_EQ(
      run_cleave({"record", "--scene", "ladder_free", "--at", "1", "--out", directory / "free"}).exit_code,
      0);
  const std::string free = directory / "free/ladder_free_step000001.h5";
  const ProgramResult rowless = run_cleave({"calibrate", one, free, "--out", out, "--repeats", "1"});
  EXPECT_EQ(rowless.exit_code, 1);
  EXPECT_NE(rowless.err.find(free + ": has no constraint row"), std::string::npos) << rowless.err;
  // Before anything is timed.
  const ProgramResult idle = run_cleave({"calibrate", one, two, "--out", out, "--seed", "1"});
  EXPECT_EQ(idle.exit_code, 1);
  EXPECT_NE(idle.err.find("--seed: is of simulated scenes"), std::string::npos) << idle.err;
  const ProgramResult nowhere = run_cleave({"calibrate", one, two, "--out", directory / "none/own.toml"});
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_NE(nowhere.err.find("none/own.toml cannot be written: there is no directory"), std::string::npos)
      << nowhere.err;
  EXPECT_EQ(nowhere.err.find("timing on"), std::string::npos) << nowhere.err;
  const ProgramResult over = run_cleave({"calibrate", one, two, "--out", one, "--force"});
  EXPECT_EQ(over.exit_code, 1);
  EXPECT_NE(over.err.find("would replace " + one + ", which is read"), std::string::npos) << over.err;
  const Arguments calibrate = {"calibrate", one, two, "--out", out, "--repeats", "1"};
  const ProgramResult made = run_cleave(calibrate);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string text = read_text(out);
  for (const char* piece : {"errors_schur-rows_1 = ", "[schur-rows.threads-1]", "[schur-bodies.threads-2]",
                            "[monolithic.threads-2]", "cpu = ", "build = "})
    EXPECT_NE(text.find(piece), std::string::npos) << piece;
  const ProgramResult onto = run_cleave(calibrate);
  EXPECT_EQ(onto.exit_code, 1);
  EXPECT_NE(onto.err.find("--force"), std::string::npos) << onto.err;
  EXPECT_EQ(read_text(out), text);
  const Arguments run = kPile + Arguments{"--partitioner", "auto", "--refiner", "none", "--calibration", out};
  ASSERT_EQ(run_cleave(run + Arguments{"--out", directory / "run"}).exit_code, 0);
  const std::string fingerprint = read_csv(directory / "run/steps.csv").at(0, "calibration");
  EXPECT_NE((made.out + made.err).find("calibration " + fingerprint), std::string::npos) << made.err;
}

TEST(CostOptions, TheObjectiveReplacesTheRefiner) {
  const TemporaryDirectory directory;
  const Arguments split = {"--partitioner", "mix,single", "--max-bodies", "10"};
  const Arguments by_option = {"--refiner", "none,fm@max-growth=0.3", "--objective", "cost"};
  const CsvTable option = rows_of(split + by_option, directory / "option");
  const CsvTable name =
      rows_of(split + Arguments{"--refiner", "none,fm-cost@max-growth=0.3"}, directory / "name");
  ASSERT_EQ(option.rows.size(), 12u);
  EXPECT_EQ(std::ranges::count(option.column("refiner"), "fm-cost@max-growth=0.3"), 6);
  for (const char* column : {"refiner", "parts", "interface_rows", "calibration", "solution_hash"})
    EXPECT_EQ(option.column(column), name.column(column)) << column;
  const ProgramResult again =
      run_cleave({"run", "--config", directory / "option/manifest.json", "--out", directory / "again"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_csv(directory / "again/steps.csv").column("run_id"), option.column("run_id"));
  const ProgramResult replaced = run_cleave({"run", "--config", directory / "option/manifest.json",
                                             "--refiner", "kl", "--out", directory / "replaced"});
  EXPECT_EQ(replaced.exit_code, 0) << replaced.err;
}

// What grows by a rule stays; what chooses of several trials chooses by the modelled time.
TEST(CostOptions, TheObjectiveReplacesPartitionersThatChoose) {
  const TemporaryDirectory directory;
  const std::string parts = directory / "parts.txt", own = "file@path=" + parts;
  std::ofstream file(parts);
  for (int body = 0; body < 40; ++body) file << body / 20 << "\n";
  file.close();
  const Arguments more = {"--refiner", "none", "--max-bodies", "10", "--cost-kernel", "schur-bodies"};
  const CsvTable option =
      rows_of(more + Arguments{"--partitioner", "mindp,multilevel@effort=best,karger@trials=5," + own,
                               "--objective", "cost"},
              directory / "option");
  const CsvTable name = rows_of(
      more + Arguments{"--partitioner", "mindp,multilevel-cost@effort=best,karger-cost@trials=5," + own},
      directory / "name");
  ASSERT_EQ(option.rows.size(), 12u);
  EXPECT_EQ(std::ranges::count(option.column("partitioner"), "mindp"), 3);
  EXPECT_EQ(std::ranges::count(option.column("partitioner"), "karger-cost@trials=5"), 3);
  for (const char* column : {"partitioner", "parts", "interface_rows", "calibration", "solution_hash"})
    EXPECT_EQ(option.column(column), name.column(column)) << column;
  for (std::size_t row = 0; row < option.rows.size(); ++row)
    EXPECT_EQ(is_fingerprint(option.at(row, "calibration")),
              option.at(row, "partitioner").find("-cost") != std::string::npos);
}

TEST(CostOptions, AllLeavesOutWhatHasATwin) {
  const TemporaryDirectory directory;
  const ProgramResult result =
      run_cleave(kPile + Arguments{"--partitioner", "all", "--refiner", "fm", "--max-bodies", "10",
                                   "--trials", "2", "--objective", "cost", "--out", directory / "out"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const CsvTable rows = read_csv(directory / "out/steps.csv");
  EXPECT_EQ(std::ranges::count(rows.column("partitioner"), "multilevel"), 0);
  EXPECT_EQ(std::ranges::count(rows.column("partitioner"), "multilevel-cost"), 3);
  EXPECT_EQ(std::ranges::count(rows.column("refiner"), "fm"), 0);
  for (const char* line :
       {"--partitioner all leaves out multilevel, which multilevel-cost replaces under --objective cost",
        "--partitioner all leaves out karger, which karger-cost replaces under --objective cost"})
    EXPECT_NE((result.out + result.err).find(line), std::string::npos) << line << "\n" << result.err;
}

// What was chosen is stored with the parts, so that each file is verified alone; parts that are taken over
// keep it.
TEST(CostOptions, StoredPartsOfAutoAreMadeAgain) {
  const TemporaryDirectory directory;
  const Arguments record = {"record", "--scene", "rock_pile",  "--bodies",
                            "60",     "--at",    "70,150,151", "--out"};
  ASSERT_EQ(run_cleave(record + Arguments{directory / "made"}).exit_code, 0);
  const auto replay = [&](const Arguments& steps, const Arguments& more) {
    Arguments words = {
        "replay", "--write-solutions", "--partitioner", "auto", "--refiner", "none", "--repeats",
        "1",      "--solver",          "schur"};
    for (const std::string& step : steps)
      words.push_back(directory / ("made/rock_pile_step000" + step + ".h5"));
    const std::string out = directory / ("replayed" + steps.back());
    const ProgramResult replayed = run_cleave(words + more + Arguments{"--out", out});
    EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
    const ProgramResult verified = run_cleave({"verify", out});
    EXPECT_EQ(verified.exit_code, 0) << verified.out;
    return read_csv(out + "/steps.csv");
  };
  const CsvTable anew = replay({"070", "150"}, {});
  EXPECT_NE(anew.at(0, "auto_choice"), "-");
  EXPECT_NE(anew.at(1, "auto_choice"), "-");
  const CsvTable kept = replay({"150", "151"}, {"--repartition", "on-change"});
  EXPECT_EQ(kept.at(0, "partition_origin"), "fresh");
  EXPECT_NE(kept.at(1, "partition_origin"), "fresh");
  EXPECT_EQ(kept.at(1, "auto_choice"), kept.at(0, "auto_choice"));
}

TEST(CostOptions, AStoredChoiceIsReadAndKeptTo) {
  SplitSetup setup{read_named("partitioner", "auto"), read_named("refiner", "none")};
  setup.choice = "mix@max-bodies=50+fm/schur-rows";
  StoredPartition stored = stored_partition(setup, {0, 0, 1}, {}, PartitionOrigin::fresh);
  EXPECT_EQ(read_split_setup(stored).choice, setup.choice);
  Split split;
  split.graph = BodyGraph(std::vector(3, 1.0), std::vector<ConstraintLink>{{0, 1, 3}});
  Splitter(read_split_setup(stored)).run(split);
  EXPECT_EQ(split.parts.choice, setup.choice);
  setup.choice = "mix@max-bodies=51+fm/schur-rows";
  EXPECT_THROW(Splitter{setup}, std::invalid_argument);
}

}  // namespace
}  // namespace cleave
