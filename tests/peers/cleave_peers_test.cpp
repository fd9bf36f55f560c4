// The program cleave_peers, and that cleave itself has nothing of it.
#include <gtest/gtest.h>

#include "harness/files/problem_file.h"
#include "tests/harness/run_program.h"
#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

TEST(CleavePeers, ReplaysBesideOurs) {
  const auto list = run_program(CLEAVE_PEERS_PROGRAM, {"list", "solvers"});
  ASSERT_NE(list.out.find("bullet-dantzig"), std::string::npos) << list.err;
  // The list names each absent solver and what to install for it.
  if (list.out.find("is not in this build") != std::string::npos) GTEST_SKIP() << list.out;
  const TemporaryDirectory directory;
  ProblemFile file;
  file.problem = make_pile(1, {.columns = 2, .rows = 1, .layers = 2, .cfm = 1e-4});
  file.position.assign(3 * file.problem.body_count(), 0.0);
  file.orientation.assign(4 * file.problem.body_count(), 0.0);
  for (int i = 0; i < file.problem.body_count(); ++i) file.orientation[4 * i] = 1;
  write_problem_file(directory / "pile.h5", file);
  const auto replay = run_program(CLEAVE_PEERS_PROGRAM, {"replay", directory / "pile.h5", "--solver",
                                                         "exact,bullet-dantzig,dart-dantzig,siconos-nsgs",
                                                         "--write-solutions", "--out", directory / "out"});
  EXPECT_EQ(replay.exit_code, 2) << replay.err;  // siconos-nsgs refuses boxes
  const CsvTable rows = read_csv(directory / "out" / "steps.csv");
  EXPECT_EQ(rows.column("status"), (std::vector<std::string>{"ok", "ok", "ok", "refused"}));
  EXPECT_EQ(rows.at(1, "peer_max_rows"), "3000");
  const auto verify = run_program(CLEAVE_PEERS_PROGRAM, {"verify", directory / "out"});
  EXPECT_EQ(verify.exit_code, 0) << verify.err;

  const auto error = run_program(CLEAVE_PEERS_PROGRAM, {"siconos-error", directory / "out" / "pile.h5"});
  EXPECT_EQ(error.exit_code, 0) << error.err;
  const CsvTable errors = parse_csv(error.out);
  EXPECT_EQ(errors.column("solver"), (std::vector<std::string>{"bullet-dantzig", "dart-dantzig", "exact"}));
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_LE(std::stod(errors.at(row, "residual_m_per_s")), 1e-9);
    EXPECT_LE(std::stod(errors.at(row, "velocity_difference_m_per_s")), 1e-6);
    EXPECT_GE(std::stod(errors.at(row, "siconos_error")), 0);
  }
}

TEST(CleavePeers, TheirCommandSaysWhatItNeeds) {
  const TemporaryDirectory directory;
  const auto none = run_program(CLEAVE_PEERS_PROGRAM, {"siconos-error"});
  EXPECT_EQ(none.exit_code, 1);
  const std::string wanted = CLEAVE_HAS_SICONOS ? "FILES" : "install libsiconos-numerics-dev";
  EXPECT_NE(none.err.find(wanted), std::string::npos) << none.err;
}

TEST(Cleave, KnowsAndLinksNoPeer) {
  const auto listed = run_program(CLEAVE_PROGRAM, {"list", "solvers", "--names"});
  for (const char* peer : {"bullet", "dart", "ipopt", "siconos"})
    EXPECT_EQ(listed.out.find(peer), std::string::npos) << peer;
  const auto linked = run_program("/usr/bin/ldd", {CLEAVE_PROGRAM});
  EXPECT_NE(linked.out.find("libode"), std::string::npos) << linked.err;
  for (const char* library : {"Bullet", "dart", "ipopt", "siconos", "mujoco"})
    EXPECT_EQ(linked.out.find(library), std::string::npos) << library;
}

}  // namespace
}  // namespace cleave
