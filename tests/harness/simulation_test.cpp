// Whole runs of the program on small scenes: every row exact, the same again, whatever the threads, and
// complete lines whatever ends the run.
#include "harness/experiment/simulation.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "harness/base/names.h"
#include "harness/experiment/run_summary.h"
#include "harness/experiment/small_islands.h"
#include "harness/experiment/splitter.h"
#include "partition/registry.h"
#include "tests/harness/machine_columns.h"
#include "tests/harness/run_program.h"
#include "tests/scenarios/shipped_scenes.h"

namespace cleave {
namespace {

const Arguments kTinyPile = {"--scene", "rock_pile", "--bodies", "12"};

double number(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

struct Finished {
  ProgramResult result;
  CsvTable table;
};

Finished run(const Arguments& arguments) {
  const TemporaryDirectory directory;
  Finished run;
  run.result = run_cleave(Arguments{"run", "--out", directory / "out"} + arguments);
  run.table = read_csv(directory / "out/steps.csv");
  return run;
}

// All cells but those of the machine.
std::vector<std::vector<std::string>> repeatable_cells(const CsvTable& table) {
  std::vector<std::vector<std::string>> rows(table.rows.size());
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    if (is_of_the_machine(table.header[c])) continue;
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r].push_back(table.rows[r][c]);
  }
  return rows;
}

void expect_exact(const Finished& run, std::size_t rows) {
  EXPECT_EQ(run.result.exit_code, 0) << run.result.err;
  ASSERT_EQ(run.table.rows.size(), rows);
  for (std::size_t r = 0; r < rows; ++r) {
    ASSERT_EQ(run.table.rows[r].size(), run.table.header.size());
    EXPECT_EQ(run.table.at(r, "status"), "ok");
    const double limit = 1e-9 * std::max(1.0, number(run.table.at(r, "largest_free_velocity_m_per_s")));
    EXPECT_LE(number(run.table.at(r, "residual_m_per_s")), limit);
    EXPECT_LE(number(run.table.at(r, "velocity_spread_m_per_s")), 1e-8);
  }
}

TEST(Smoke, EverySceneRunsSmallWithAllCombinations) {
  const std::map<std::string, Arguments> small = {
      {"chain_drop", {"--links", "12"}},
      {"log_tower", {"--layers", "4", "--logs", "2"}},
      {"rock_pile", {"--bodies", "12"}},
      {"large_rock_pile", {"--bodies", "12"}},
      {"silo", {"--bodies", "12"}},
      {"crane", {"--links", "6", "--dt", "0.001", "--cfm", "1e-10"}},
      {"mixed_site", {"--links", "50", "--rings", "1", "--dt", "0.001", "--cfm", "1e-10"}},
  };
  for (const ShippedScene& scene : shipped_scenes()) {
    const auto sizes = small.find(scene.name);
    const Arguments size = sizes == small.end() ? Arguments{} : sizes->second;
    const Finished smoke = run(arguments_of(scene) +
                               Arguments{"--max-bodies", "4", "--steps", "90", "--measure-every", "45",
                                         "--solver", "schur,monolithic"} +
                               size);
    SCOPED_TRACE(scene.name);
    expect_exact(smoke, 2 * (5 * 3 + 1));
    EXPECT_EQ(smoke.table.at(15, "partitioner"), "-");
    EXPECT_EQ(smoke.table.at(15, "solver"), "monolithic");
  }
}

TEST(Run, OneStepIsOneProblemForAllCombinations) {
  const Finished pile =
      run(kTinyPile + Arguments{"--steps", "60", "--measure-every", "60", "--max-bodies", "4"});
  expect_exact(pile, 15);
  for (const char* column :
       {"problem_hash", "state_hash", "potential_energy_j", "rows", "contacts", "islands"})
    for (const std::string& cell : pile.table.column(column))
      EXPECT_EQ(cell, pile.table.at(0, column)) << column;
  EXPECT_EQ(pile.table.at(0, "step"), "59");
}

TEST(Run, RowsAddUp) {
  const Finished pile =
      run(kTinyPile + Arguments{"--steps", "60", "--measure-every", "20", "--max-bodies", "4"});
  const CsvTable& table = pile.table;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    EXPECT_EQ(number(table.at(r, "rows")), number(table.at(r, "rows_bilateral")) +
                                               number(table.at(r, "rows_normal")) +
                                               number(table.at(r, "rows_friction")));
    EXPECT_EQ(number(table.at(r, "rows_normal")), number(table.at(r, "contacts")));
    EXPECT_LE(number(table.at(r, "t_s_min_ms")), number(table.at(r, "t_s_ms")));
    EXPECT_EQ(table.at(r, "interface_unknowns"),
              table.at(r, "interface_rows"));  // schur-rows: one per cut row
    if (table.at(r, "refiner") != "none") continue;
    EXPECT_EQ(table.at(r, "parts"), table.at(r, "parts_before"));
    EXPECT_EQ(table.at(r, "interface_rows"), table.at(r, "interface_rows_before"));
    EXPECT_LE(number(table.at(r, "max_part_bodies")), 4);
  }
}

TEST(Run, TwiceTheSameIsTheSame) {
  const Arguments arguments =
      kTinyPile + Arguments{"--steps", "60", "--measure-every", "15", "--max-bodies", "4"};
  const Finished first = run(arguments), second = run(arguments);
  ASSERT_EQ(first.table.rows.size(), 60u);
  EXPECT_EQ(repeatable_cells(first.table), repeatable_cells(second.table));
  const Finished other_seed = run(arguments + Arguments{"--seed", "2"});
  EXPECT_NE(first.table.column("state_hash"), other_seed.table.column("state_hash"));
}

TEST(Run, TwoThreadsAreOneThread) {
  for (const Arguments& scene :
       {Arguments{"--scene", "log_tower", "--layers", "6", "--logs", "3"}, kTinyPile}) {
    const Arguments arguments =
        scene + Arguments{"--steps",      "60",      "--measure-every", "20",
                          "--max-bodies", "4",       "--partitioner",   "mindp,mix",
                          "--refiner",    "none,fm", "--solver",        "schur,monolithic",
                          "--repeats",    "1"};
    const Finished one = run(arguments + Arguments{"--threads", "1"});
    const Finished two = run(arguments + Arguments{"--threads", "2"});
    ASSERT_EQ(one.table.rows.size(), 15u);
    EXPECT_EQ(repeatable_cells(one.table), repeatable_cells(two.table));
    EXPECT_EQ(two.table.at(0, "threads"), "2");
  }
}

TEST(Run, MeasuringDoesNotMoveTheWorld) {
  const Arguments arguments = kTinyPile + Arguments{"--steps", "60"};
  const Finished often = run(arguments + Arguments{"--measure-every", "6", "--partitioner", "mix"});
  const Finished seldom =
      run(arguments + Arguments{"--measure-every", "60", "--partitioner", "bfs", "--repeats", "1"});
  EXPECT_EQ(often.table.rows.size(), 30u);
  EXPECT_EQ(often.table.at(29, "state_hash"), seldom.table.at(0, "state_hash"));
}

TEST(Run, SeparateWorldsOneAfterTheOther) {
  const Finished separate =
      run(kTinyPile + Arguments{"--mode", "separate", "--partitioner", "mindp,mix", "--refiner", "fm",
                                "--steps", "40", "--measure-every", "20", "--max-bodies", "4"});
  expect_exact(separate, 4);
  EXPECT_EQ(separate.table.column("partitioner"), (Arguments{"mindp", "mindp", "mix", "mix"}));
  EXPECT_EQ(separate.table.column("step"), (Arguments{"19", "39", "19", "39"}));
  // Different solutions within the limit: the worlds agree in every figure that is not read to the last
  // digit.
  EXPECT_NEAR(number(separate.table.at(0, "kinetic_energy_j")),
              number(separate.table.at(2, "kinetic_energy_j")), 1e-3);
}

TEST(Run, EveryFrictionModelIsExact) {
  for (const Arguments& friction : {Arguments{"--friction", "none"}, Arguments{"--friction", "box"},
                                    Arguments{"--friction", "constant", "--friction-force-n", "50"},
                                    Arguments{"--friction", "box-converged"}, Arguments{"--mu", "0"}}) {
    const Finished pile = run(kTinyPile + friction +
                              Arguments{"--steps", "60", "--measure-every", "30", "--partitioner", "mindp",
                                        "--refiner", "fm", "--max-bodies", "4"});
    SCOPED_TRACE(joined(friction, " "));
    expect_exact(pile, 2);
    EXPECT_EQ(pile.table.at(1, "friction"), friction[0] == "--mu" ? "box" : friction[1]);
    const bool frictionless = friction[1] == "none" || friction[0] == "--mu";
    EXPECT_EQ(number(pile.table.at(1, "rows_friction")) == 0, frictionless);
  }
}

TEST(Run, OddSizesAreOrdinary) {
  // One body, more room than bodies, nothing touching yet, no step at all.
  const Arguments small = {"--scene", "rock_pile", "--solver", "schur,monolithic", "--partitioner", "mr"};
  expect_exact(run(small + Arguments{"--bodies", "1", "--steps", "60", "--measure-every", "20"}), 12);
  const Finished falling = run(small + Arguments{"--bodies", "3", "--steps", "1"});
  expect_exact(falling, 4);
  EXPECT_EQ(falling.table.at(0, "contacts"), "0");
  EXPECT_NE(falling.result.err.find("under 20 %"), std::string::npos) << falling.result.err;
  expect_exact(
      run(small + Arguments{"--bodies", "6", "--steps", "40", "--measure-every", "40", "--max-bodies", "1"}),
      4);
  const Finished nothing = run(small + Arguments{"--steps", "0"});
  EXPECT_EQ(nothing.result.exit_code, 0) << nothing.result.err;
  EXPECT_TRUE(nothing.table.rows.empty());
}

// The judge's word stands above the solver's, and failed cells are rows.
TEST(Run, InexactRowsAreNamedAndCounted) {
  const Finished pile = run(
      kTinyPile + Arguments{"--solver", "pgs", "--sweeps", "2", "--steps", "80", "--measure-every", "40"});
  EXPECT_EQ(pile.result.exit_code, 2);
  ASSERT_EQ(pile.table.rows.size(), 2u);
  EXPECT_EQ(pile.table.at(1, "status"), "not_converged");
  EXPECT_GT(number(pile.table.at(1, "residual_m_per_s")), 1e-9);
  EXPECT_NE(pile.result.err.find("pgs: not_converged"), std::string::npos) << pile.result.err;
}

// 1.15 GB of matrix where 0.8 are allowed.
TEST(Run, ASolveWithoutMemoryIsARowThatMeasuredNothing) {
  const TemporaryDirectory directory;
  const std::string out = directory / "out";
  const std::string command = std::string("ulimit -v 800000; OPENBLAS_NUM_THREADS=1 exec ") + CLEAVE_PROGRAM +
                              " run --scene rock_pile --bodies 2000 --steps 1 --solver dense" +
                              " --advance monolithic --memory-limit 100 --out " + out;
  const ProgramResult result = run_program("/bin/bash", {"-c", command});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  const CsvTable table = read_csv(directory / "out/steps.csv");
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.at(0, "status"), "out_of_memory");
  EXPECT_NE(table.at(0, "status_reason"), "-");
  for (const char* column : {"t_s_ms", "t_s_min_ms", "t_s_max_ms", "t_s_cpu_ms", "t_s_other_ms",
                             "residual_m_per_s", "residual_relative", "kinetic_energy_j"})
    EXPECT_EQ(table.at(0, column), "nan") << column;
  EXPECT_EQ(table.at(0, "factorizations"), "-1");
  EXPECT_EQ(table.at(0, "solution_hash"), "-");
}

TEST(Run, TimesOfTheRepeatsStandInOrder) {
  const Finished pile = run(kTinyPile + Arguments{"--repeats", "4", "--steps", "60", "--measure-every", "30",
                                                  "--solver", "schur,pgs,ode-quickstep"});
  ASSERT_GE(pile.table.rows.size(), 6u);
  for (std::size_t r = 0; r < pile.table.rows.size(); ++r) {
    const double t_s_ms = number(pile.table.at(r, "t_s_ms"));
    EXPECT_LE(number(pile.table.at(r, "t_s_min_ms")), t_s_ms);
    EXPECT_GE(number(pile.table.at(r, "t_s_max_ms")), t_s_ms);
    EXPECT_GT(number(pile.table.at(r, "t_s_cpu_ms")), 0);
    const std::string& waiting = pile.table.at(r, "t_s_waiting_ms");  // nan on a kernel without schedstat
    EXPECT_TRUE(waiting == "nan" || number(waiting) >= 0) << waiting;
    EXPECT_EQ(pile.table.at(r, "core_round_trip_ns"), "nan");  // one thread
    EXPECT_GT(number(pile.table.at(r, "peak_memory_mb")), 1);
  }
}

TEST(RunSummary, ANumberAfterOneThatIsNoneDoesNotHideIt) {
  StepRecord row;
  RunSummary summary;
  for (const auto& [status, residual] :
       {std::pair{"not_converged", 0.5}, std::pair{"timeout", kUnmeasured}, std::pair{"ok", 1e-12}}) {
    row.status = status;
    row.residual_m_per_s = residual;
    summary.add(row);
  }
  EXPECT_EQ(summary.worst_residual_m_per_s, 0.5);  // a solve that ended without a result has no residual
  row.status = "diverged";
  row.residual_m_per_s = kUnmeasured;
  summary.add(row);
  row.status = "ok";
  row.residual_m_per_s = 1e-12;
  summary.add(row);
  EXPECT_TRUE(std::isnan(summary.worst_residual_m_per_s));
}

TEST(RunSummary, SaysWhenSolvesWaitedForACore) {
  StepRecord row;
  row.status = "ok";
  row.t_s_ms = 50;
  RunSummary summary;
  for (const double waiting_ms : {5.0, 0.0}) {  // 5 of 100 ms: not yet more than a twentieth
    row.t_s_waiting_ms = waiting_ms;
    summary.add(row);
  }
  EXPECT_EQ(summary.text().find("waited"), std::string::npos) << summary.text();
  row.t_s_waiting_ms = kUnmeasured;  // a row that does not know says nothing
  summary.add(row);
  EXPECT_EQ(summary.text().find("waited"), std::string::npos) << summary.text();
  row.t_s_waiting_ms = 25;
  summary.add(row);
  EXPECT_NE(summary.text().find("the threads of the solves waited 30 ms for a core in solves of 150 ms"),
            std::string::npos)
      << summary.text();
}

TEST(RunSummary, SaysWhenCoresWereFarApart) {
  StepRecord row;
  row.status = "ok";
  RunSummary summary;
  const auto add = [&](double t_s_ms, double round_trip_ns) {
    row.t_s_ms = t_s_ms;
    row.core_round_trip_ns = round_trip_ns;
    summary.add(row);
  };
  add(95, RunSummary::kFarNs - 1);
  add(5, RunSummary::kFarNs);  // 5 of 100 ms: not yet more than a twentieth
  add(1000, kUnmeasured);      // says nothing
  EXPECT_EQ(summary.text().find("far apart"), std::string::npos) << summary.text();
  add(25, 510);
  EXPECT_NE(summary.text().find("for 24 % of the time of the solves their threads were on cores far apart"),
            std::string::npos)
      << summary.text();
}

// A world that cannot go on: the steps that are left are rows, and the run says so.
TEST(Run, WorldThatBlowsUpLeavesRowsNotGaps) {
  for (const char* dt : {"1e100", "1e200", "1e308"}) {
    const Finished blown = run({"--scene", "chain_drop", "--links", "5", "--dt", dt, "--steps", "6",
                                "--solver", "monolithic", "--advance", "monolithic"});
    EXPECT_EQ(blown.result.exit_code, 2) << blown.result.err;
    ASSERT_EQ(blown.table.rows.size(), 6u) << dt;
    EXPECT_EQ(blown.table.at(5, "status"), "skipped") << dt;
    EXPECT_EQ(blown.table.at(5, "residual_m_per_s"), "nan") << dt;
    EXPECT_NE(blown.result.err.find("worlds stopped early"), std::string::npos) << blown.result.err;
  }
}

void expect_complete_lines(const std::string& text) {
  ASSERT_FALSE(text.empty());
  EXPECT_EQ(text.back(), '\n');
  const CsvTable table = parse_csv(text);
  EXPECT_GT(table.rows.size(), 0u);
  EXPECT_EQ(table.rows.size() % 3, 0u);  // the rows of a step come together
  for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
}

// Starts an endless run, waits for its first rows, sends the signal; the exit code.
int interrupted_run(const std::filesystem::path& out, int signal) {
  const pid_t process =
      start_cleave(Arguments{"run", "--out", out} + kTinyPile +
                   Arguments{"--steps", "100000000", "--partitioner", "mindp", "--repeats", "1"});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (count_lines(read_text(out / "steps.csv")) < 30 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ::kill(process, signal);
  return finish_cleave(process);
}

TEST(Interrupt, LeavesWholeStepsAndSaysSo) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const TemporaryDirectory directory;
    EXPECT_EQ(interrupted_run(directory / "out", signal), 130);
    expect_complete_lines(read_text(directory / "out/steps.csv"));
    EXPECT_NE(read_text(directory / "out/manifest.json").find("\"state\": \"interrupted\""),
              std::string::npos);
  }
}

TEST(Interrupt, KilledRunLeavesCompleteLines) {
  const TemporaryDirectory directory;
  EXPECT_EQ(interrupted_run(directory / "out", SIGKILL), 128 + SIGKILL);
  expect_complete_lines(read_text(directory / "out/steps.csv"));
  EXPECT_NE(read_text(directory / "out/manifest.json").find("\"state\": \"running\""), std::string::npos);
}

// All that know what a small island is.
std::vector<Algorithm> with_max_bodies(int max_bodies) {
  std::vector<Algorithm> list = read_list("partitioner", "all", {{"max-bodies", std::to_string(max_bodies)}});
  std::erase_if(list, [](const Algorithm& algorithm) { return !algorithm.settings.has("max-bodies"); });
  EXPECT_GE(list.size(), 5u);
  return list;
}

// Bodies in a row, three a group.
BodyGraph row_of_bodies(const std::vector<double>& mass_kg, const std::vector<ConstraintLink>& links) {
  std::vector<double> position_m;
  std::vector<int> group;
  for (int body = 0; body < std::ssize(mass_kg); ++body) {
    position_m.insert(position_m.end(), {static_cast<double>(body), 0.0, 0.0});
    group.push_back(body / 3);
  }
  BodyGraph graph(mass_kg, links, std::nullopt, position_m);
  graph.set_groups(group);
  return graph;
}

// Islands {0, 2} and {1, 3, 4, 5, 6} and the single body 7, with at most three bodies a part.
TEST(SmallIslands, BecomeOnePartEachAfterTheLargeOnes) {
  const std::vector<double> mass_kg = {1, 1, 1000, 1, 1, 1, 1, 1};  // mr alone would split {0, 2}
  const std::vector<ConstraintLink> links = {{0, 2, 3}, {0, 2, 1}, {1, 3, 3},
                                             {3, 4, 3}, {4, 5, 3}, {5, 6, 3}};
  const BodyGraph graph = row_of_bodies(mass_kg, links);
  for (const Algorithm& entry : with_max_bodies(3)) {
    const std::unique_ptr<Partitioner> partitioner = make_partitioner(entry);
    const Partition partition = partition_large_islands(graph, *partitioner, 3);
    const std::vector<int>& part = partition.part_of_body;
    const PartitionMetrics metrics = measure_partition(graph, part);
    SCOPED_TRACE(entry.name);
    EXPECT_EQ(part[0], part[2]);
    EXPECT_EQ(part[7], partition.part_count - 1);
    EXPECT_EQ(part[0], partition.part_count - 2);
    EXPECT_EQ(metrics.parts, partition.part_count);
    EXPECT_LE(metrics.max_part_bodies, 3);
    EXPECT_TRUE(metrics.contiguous || !partitioner->promised().contiguous);
    for (const int body : {1, 3, 4, 5, 6}) EXPECT_LT(part[body], partition.part_count - 2);
  }
}

// Without small islands the option changes nothing: the induced graph has the same weights.
TEST(SmallIslands, LargeGraphIsPartitionedAsBefore) {
  std::vector<double> mass_kg(30, 1.0);
  std::vector<ConstraintLink> links;
  for (int body = 0; body < 30; ++body) {
    for (const int other : {body + 1, body + 7})
      for (int k = 0; other < 30 && k < 1 + (body * other) % 4; ++k)
        links.push_back({body, other, 1 + (body + k) % 3});
  }
  const BodyGraph graph = row_of_bodies(mass_kg, links);
  for (const Algorithm& entry : with_max_bodies(5)) {
    const auto partitioner = make_partitioner(entry);
    EXPECT_EQ(partition_large_islands(graph, *partitioner, 5).part_of_body,
              partitioner->run(graph).part_of_body)
        << entry.name;
  }
}

}  // namespace
}  // namespace cleave
