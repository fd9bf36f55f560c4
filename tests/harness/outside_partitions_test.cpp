// Partitions that another program made: from `cleave export` through METIS back into `--partitioner file`,
// and what happens to steps that the files do not fit.
#include <gtest/gtest.h>
#ifdef CLEAVE_METIS
#include <metis.h>
#else
using idx_t = int;  // of METIS's arrays
#endif

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "harness/base/hash.h"
#include "harness/experiment/problem_graph.h"
#include "harness/files/problem_file.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
// A graph file as METIS's manual describes it, of format 001, in METIS's own arrays.
struct MetisGraph {
  std::vector<idx_t> first{0}, neighbour, weight;
  idx_t bodies = 0, edges = 0;
};

MetisGraph read_metis_graph(const fs::path& path) {
  MetisGraph graph;
  std::istringstream text(read_text(path));
  std::string line, format;
  std::getline(text, line);
  std::istringstream(line) >> graph.bodies >> graph.edges >> format;
  EXPECT_EQ(format, "001");
  while (std::getline(text, line)) {
    std::istringstream words(line);
    for (idx_t other = 0, weight = 0; words >> other >> weight;) {
      graph.neighbour.push_back(other - 1);
      graph.weight.push_back(weight);
    }
    graph.first.push_back(static_cast<idx_t>(graph.neighbour.size()));
  }
  return graph;
}

// Writes the part ids as gpmetis does.
void partition_with_metis(MetisGraph& graph, idx_t parts, const fs::path& path) {
#ifdef CLEAVE_METIS
  std::vector<idx_t> part_of_body(graph.bodies);
  idx_t constraints = 1, cut = 0;
  ASSERT_EQ(METIS_PartGraphRecursive(&graph.bodies, &constraints, graph.first.data(), graph.neighbour.data(),
                                     nullptr, nullptr, graph.weight.data(), &parts, nullptr, nullptr, nullptr,
                                     &cut, part_of_body.data()),
            METIS_OK);
  std::ofstream file(path, std::ios::binary);
  for (const idx_t part : part_of_body) file << part << "\n";
#else
  GTEST_SKIP() << "a build without METIS (libmetis-dev): " << path << " with " << parts << " parts of "
               << graph.bodies << " bodies";
#endif
}

class OutsidePartitions : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new TemporaryDirectory;
    const ProgramResult result = run_cleave({"record", "--scene", "rock_pile", "--bodies", "20", "--at", "80",
                                             "--out", *directory_ / "recorded"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  static void TearDownTestSuite() { delete directory_; }

  static fs::path problem() { return *directory_ / "recorded" / "rock_pile_step000080.h5"; }
  fs::path operator/(const std::string& name) const { return own_ / name; }
  std::string write_parts(const std::string& name, int lines, int parts) const {
    std::ofstream file(own_ / name, std::ios::binary);
    for (int i = 0; i < lines; ++i) file << i % parts << "\n";
    return own_ / name;
  }
  ProgramResult replay(const std::string& pattern, const std::string& out, Arguments more = {}) const {
    Arguments arguments = {"replay", problem(),  "--partitioner", "file@path=" + pattern,
                           "--out",  own_ / out, "--repeats",     "1"};
    if (std::ranges::find(more, "--refiner") == more.end()) more.insert(more.end(), {"--refiner", "none"});
    std::ranges::move(more, std::back_inserter(arguments));
    return run_cleave(arguments);
  }

 private:
  static TemporaryDirectory* directory_;
  TemporaryDirectory own_;
};
TemporaryDirectory* OutsidePartitions::directory_ = nullptr;

TEST_F(OutsidePartitions, ExportedGraphIsTheBodyGraph) {
  const ProgramResult result =
      run_cleave({"export", problem(), "--format", "metis", "--out", *this / "a.graph"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const MetisGraph found = read_metis_graph(*this / "a.graph");
  const BodyGraph graph = body_graph_of(read_problem_file(problem()).problem);
  ASSERT_EQ(found.bodies, 20);
  ASSERT_EQ(found.first.size(), 21u);
  ASSERT_GT(graph.edge_count(), 10);
  EXPECT_EQ(found.edges, graph.edge_count());
  for (int body = 0; body < 20; ++body) {
    ASSERT_EQ(found.first[body + 1], graph.last(body));
    for (int edge = graph.first(body); edge < graph.last(body); ++edge) {
      EXPECT_EQ(found.neighbour[edge], graph.neighbour(edge));
      EXPECT_EQ(found.weight[edge], graph.weight(edge, EdgeWeight::rows));
    }
  }
}

TEST_F(OutsidePartitions, ExportRefusesInOneLine) {
  const std::string out = *this / "a.graph";
  const auto error_of = [](const Arguments& arguments) {
    const ProgramResult result = run_cleave(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(count_lines(result.err), 1) << result.err;
    return result.err;
  };
  EXPECT_EQ(error_of({"export", problem(), "--format", "scotch", "--out", out}),
            "cleave export: --format: 'scotch' is unknown; choices: metis, mtx, fclib, vtu\n");
  EXPECT_FALSE(fs::exists(out));
  EXPECT_NE(error_of({"export", problem(), "--out", out}).find("--format: is required"), std::string::npos);
  EXPECT_NE(error_of({"export", problem(), "--format", "metis"}).find("--out: is required"),
            std::string::npos);
  EXPECT_NE(error_of({"export", "--format", "metis", "--out", out}).find("FILE"), std::string::npos);
  EXPECT_NE(error_of({"export", *this / "none.h5", "--format", "metis", "--out", out}).find("no such file"),
            std::string::npos);
  std::ofstream(out) << "mine";
  EXPECT_NE(error_of({"export", problem(), "--format", "metis", "--out", out}).find("exists"),
            std::string::npos);
  EXPECT_EQ(read_text(out), "mine");
  EXPECT_EQ(run_cleave({"export", problem(), "--format", "metis", "--out", out, "--force"}).exit_code, 0);
  EXPECT_TRUE(read_text(out).starts_with("20 "));
  const std::string stored = read_text(problem());
  EXPECT_NE(error_of({"export", problem(), "--format", "metis", "--out", problem(), "--force"})
                .find("which is read"),
            std::string::npos);
  EXPECT_EQ(read_text(problem()), stored);
}

TEST_F(OutsidePartitions, ExportedPartsAreThoseThatWereStored) {
  const fs::path parts = write_parts("parts.txt", 20, 3);
  ASSERT_EQ(replay(parts, "out", {"--write-solutions"}).exit_code, 0);
  const fs::path solved = *this / "out" / "rock_pile_step000080.h5";
  const std::string label = read_problem_file(solved).partitions.begin()->first;
  const std::string out = *this / "again.txt";
  ASSERT_EQ(run_cleave({"export", solved, "--format", "metis", "--partition", label, "--out", out}).exit_code,
            0);
  EXPECT_EQ(read_text(out), read_text(parts));
  const auto refusal = [&](const fs::path& file, const char* format, const std::string& name) {
    return run_cleave({"export", file, "--format", format, "--partition", name, "--out", *this / "no"}).err;
  };
  EXPECT_EQ(refusal(problem(), "metis", label),
            "cleave export: --partition: " + problem().string() +
                " stores no partition; `cleave replay --write-solutions` stores one\n");
  EXPECT_NE(refusal(solved, "metis", label + "x").find("(did you mean '" + label + "'?)"), std::string::npos);
  EXPECT_NE(refusal(solved, "vtu", label).find("--format vtu takes none"), std::string::npos);
  EXPECT_FALSE(fs::exists(*this / "no"));
}

TEST_F(OutsidePartitions, PartsOfMetisComeBackAsTheyWere) {
  ASSERT_EQ(run_cleave({"export", problem(), "--format", "metis", "--out", *this / "a.graph"}).exit_code, 0);
  MetisGraph graph = read_metis_graph(*this / "a.graph");
  partition_with_metis(graph, 4, *this / "a.graph.part.4");
  if (IsSkipped()) return;
  const ProgramResult replayed = replay(*this / "a.graph.part.4", "out", {"--write-solutions"});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  Fnv1a64 hash;
  hash.add(read_text(*this / "a.graph.part.4"));
  const std::string name = "file@" + hex(hash.value());
  const CsvTable table = read_csv(*this / "out" / "steps.csv");
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.at(0, "status"), "ok");
  EXPECT_EQ(table.at(0, "partitioner"), name);
  EXPECT_EQ(table.at(0, "parts"), "4");
  const ProblemFile file = read_problem_file(*this / "out" / "rock_pile_step000080.h5");
  const std::vector<int>& parts = file.partitions.at(name + "+none+schur").part_of_body;
  std::string text;
  for (const int part : parts) text += std::to_string(part) + "\n";
  EXPECT_EQ(text, read_text(*this / "a.graph.part.4"));

  const ProgramResult verified = run_cleave({"verify", *this / "out"});
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
  EXPECT_NE(verified.out.find("fingerprint " + hex(hash.value())), std::string::npos) << verified.out;
}

TEST_F(OutsidePartitions, VerifyFindsPartsThatAreNotThoseOfTheFile) {
  const std::string parts = write_parts("a.part", 20, 3);
  ASSERT_EQ(replay(parts, "out", {"--write-solutions", "--refiner", "none,fm"}).exit_code, 0);
  const fs::path path = *this / "out" / "rock_pile_step000080.h5";
  ASSERT_EQ(run_cleave({"verify", path}).exit_code, 0);
  const auto spoilt = [&](const std::string& refiner, auto change) {
    ProblemFile file = read_problem_file(path);
    for (auto& [label, partition] : file.partitions)
      if (partition.refiner == refiner) change(partition);
    write_problem_file(*this / "spoilt.h5", file);
    const ProgramResult result = run_cleave({"verify", *this / "spoilt.h5"});
    EXPECT_EQ(result.exit_code, 3) << result.out;
    return result.out;
  };
  EXPECT_NE(spoilt("none", [](StoredPartition& p) { std::swap(p.part_of_body[0], p.part_of_body[1]); })
                .find("FAIL"),
            std::string::npos);
  EXPECT_NE(spoilt("fm", [](StoredPartition& p) { p.partitioner = "file@12"; }).find("fingerprint of the"),
            std::string::npos);
  EXPECT_NE(spoilt("fm", [](StoredPartition& p) { p.refiner = "fn"; }).find("'fn' is unknown"),
            std::string::npos);
}

// Not where a file lies but what it says makes the run.
TEST_F(OutsidePartitions, RunIsKnownByContentAndNotByPath) {
  const auto run_id = [&](const std::string& pattern, const std::string& out) {
    EXPECT_EQ(replay(pattern, out).exit_code, 0);
    const std::string rows = read_text(*this / out / "steps.csv");
    EXPECT_EQ(rows.find(".part"), std::string::npos) << rows;
    return read_csv(*this / out / "steps.csv").at(0, "run_id");
  };
  const std::string first = run_id(write_parts("a.part", 20, 3), "a");
  EXPECT_EQ(run_id(write_parts("b.part", 20, 3), "b"), first);
  EXPECT_NE(run_id(write_parts("c.part", 20, 4), "c"), first);
  const ProgramResult twice =
      run_cleave({"replay", problem(), "--out", *this / "d", "--partitioner",
                  "file@path=" + (*this / "a.part").string() + ",file@path=" + (*this / "b.part").string()});
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_NE(twice.err.find("named twice"), std::string::npos) << twice.err;
}

TEST_F(OutsidePartitions, BadFilesAreRefusedBeforeAnythingIsCreated) {
  std::ofstream(*this / "bad.part") << "0\n2\n";
  for (const std::string name : {"bad.part", "none.part", "{stop}.part", "none{step}.part"}) {
    const ProgramResult result = replay(*this / name, "out");
    EXPECT_EQ(result.exit_code, 1) << name;
    EXPECT_EQ(count_lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find("--partitioner file: " + (*this / name).string()), std::string::npos)
        << result.err;
    EXPECT_FALSE(fs::exists(*this / "out"));
  }
  const ProgramResult nothing =
      run_cleave({"replay", problem(), "--partitioner", "file", "--out", *this / "out"});
  EXPECT_EQ(nothing.exit_code, 1);
  EXPECT_NE(nothing.err.find("file needs path"), std::string::npos) << nothing.err;
}

// A step without its file, or with one for other bodies, is a row of its own and ends nothing.
TEST_F(OutsidePartitions, StepsThatTheFilesDoNotFitAreRefused) {
  write_parts("p3.part", 20, 3);
  write_parts("p7.part", 19, 3);
  const ProgramResult result =
      run_cleave({"run", "--scene", "rock_pile", "--bodies", "20", "--steps", "12", "--measure-every", "4",
                  "--repeats", "1", "--refiner", "none", "--solver", "schur,pgs", "--partitioner",
                  "mix,file@path=" + (*this / "p{step}.part").string(), "--out", *this / "out"});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  const CsvTable table = read_csv(*this / "out" / "steps.csv");
  ASSERT_EQ(table.rows.size(), 9u);
  int refused = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (!table.at(row, "partitioner").starts_with("file@steps-")) continue;
    const std::string& step = table.at(row, "step");
    const std::string& reason = table.at(row, "status_reason");
    EXPECT_EQ(table.at(row, "status"), step == "3" ? "ok" : "refused") << step;
    if (step == "7") {
      EXPECT_NE(reason.find("p7.part: 19 lines"), std::string::npos) << reason;
    }
    if (step == "11") {
      EXPECT_NE(reason.find("no file of step 11"), std::string::npos) << reason;
    }
    if (step != "3") ++refused;
  }
  EXPECT_EQ(refused, 2);
}

// The world cannot go on with a solver whose parts it does not have.
TEST_F(OutsidePartitions, AWorldThatAdvancesOnMissingPartsStops) {
  write_parts("p0.part", 20, 3);
  const ProgramResult result =
      run_cleave({"run", "--scene", "rock_pile", "--bodies", "20", "--steps", "3", "--repeats", "1",
                  "--refiner", "none", "--advance", "schur", "--friction", "box-converged", "--partitioner",
                  "file@path=" + (*this / "p{step}.part").string(), "--out", *this / "out"});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(read_csv(*this / "out" / "steps.csv").column("status"),
            (std::vector<std::string>{"ok", "refused", "skipped"}));
}

// What was not solved is not stored.
TEST_F(OutsidePartitions, RefusedStepsStoreNoSolution) {
  const ProgramResult result = replay(write_parts("short.part", 7, 2), "out", {"--write-solutions"});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  const ProblemFile file = read_problem_file(*this / "out" / "rock_pile_step000080.h5");
  EXPECT_TRUE(file.solutions.empty());
  EXPECT_TRUE(file.partitions.empty());
  EXPECT_EQ(run_cleave({"verify", *this / "out"}).exit_code, 0);
}

TEST_F(OutsidePartitions, AllLeavesTheFileOutAndSaysSo) {
  const ProgramResult result = run_cleave({"replay", problem(), "--partitioner", "all", "--refiner", "none",
                                           "--repeats", "1", "--out", *this / "out"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("--partitioner all leaves out file, which needs path\n"), std::string::npos)
      << result.err;
  const CsvTable table = read_csv(*this / "out" / "steps.csv");
  const std::vector<std::string> names = table.column("partitioner");
  EXPECT_GE(std::set<std::string>(names.begin(), names.end()).size(), 5u);
}

// What is named beside `all` is no part of it, also where a file gives it another name.
TEST_F(OutsidePartitions, WhatIsNamedBesideAllIsNotLeftOut) {
  const std::string parts = "file@path=" + write_parts("whole.part", 20, 3);
  const ProgramResult result = run_cleave({"replay", problem(), "--partitioner", "all," + parts, "--refiner",
                                           "none", "--skip-small-islands", "--out", *this / "out"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err.find("all leaves out file@"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("has no max-bodies"), std::string::npos) << result.err;
}

// Unless a run is repeated, whose options were all stored.
TEST_F(OutsidePartitions, PartsThatNobodyReadsAreTold) {
  const std::string told = "change nothing: no solver of this run splits bodies\n";
  const Arguments parts = {"--partitioner", "mindp", "--refiner", "none"};
  const Arguments run = {"run", "--scene", "rock_pile", "--bodies", "5", "--steps", "1"};
  const ProgramResult exact =
      run_cleave(run + parts + Arguments{"--solver", "exact", "--out", *this / "exact"});
  EXPECT_NE(exact.err.find("--partitioner, --refiner " + told), std::string::npos) << exact.err;
  const ProgramResult again = run_cleave({"rerun", *this / "exact", "--out", *this / "again"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.err.find(told), std::string::npos) << again.err;
  const ProgramResult both =
      run_cleave(run + parts + Arguments{"--solver", "exact,schur", "--out", *this / "both"});
  EXPECT_EQ(both.err.find(told), std::string::npos) << both.err;
}

// A refusal is one line alone, also where it comes when the directory is made.
TEST_F(OutsidePartitions, NothingIsToldOfPartsBeforeARefusal) {
  const ProgramResult refused = run_cleave({"run", "--scene", "rock_pile", "--steps", "1", "--solver",
                                            "exact", "--refiner", "none", "--out", "/proc/no/directory"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
}

// Its partitioner is for the solver of --advance, and one that was not named is not idle.
TEST_F(OutsidePartitions, RecordTellsOfPartsThatWereNamedAlone) {
  const ProgramResult recorded = run_cleave(
      {"record", "--scene", "rock_pile", "--bodies", "3", "--at", "0", "--out", *this / "recorded"});
  EXPECT_EQ(recorded.exit_code, 0) << recorded.err;
  EXPECT_EQ(recorded.err.find("change nothing"), std::string::npos) << recorded.err;
}

}  // namespace
}  // namespace cleave
