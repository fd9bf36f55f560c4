// cleave sweep and cleave rerun as a user gives them: cells run once, killed campaigns go on, failures are
// rows, and verify finds what is damaged.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <regex>
#include <set>
#include <sstream>
#include <thread>

#include "harness/campaign/campaign_index.h"
#include "harness/campaign/cell_times.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// Some ten milliseconds a cell.
constexpr const char* kTiny = R"(
scene = "rock_pile"
bodies = 3
steps = 4
measure-every = 2
repeats = 1
partitioner = "mindp"
refiner = "none"
solver = "exact"
)";
// Until somebody ends it.
constexpr const char* kEndless = R"(
scene = "rock_pile"
bodies = 3
steps = 100000000
measure-every = 100000000
)";

// A spec, its directory, and what a test wants to know of them.
struct Campaign : TemporaryDirectory {
  explicit Campaign(const std::string& spec) { write_spec(spec); }
  fs::path spec() const { return *this / "spec.toml"; }
  fs::path out() const { return *this / "out"; }
  void write_spec(const std::string& text) const { std::ofstream(spec()) << text; }

  Words words(const Words& more) const {
    Words all = {"sweep", spec(), "--out", out()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  ProgramResult sweep(const Words& more = {}) const { return run_cleave(words(more)); }
  CsvTable index() const { return read_csv(out() / "index.csv"); }
  fs::path cell(std::size_t row = 0) const { return out() / "cells" / index().at(row, "cell"); }
  fs::path log(std::size_t row = 0) const { return out() / "failed" / (index().at(row, "cell") + ".log"); }

  // Lines of verify that begin with FAIL.
  std::string failures() const {
    std::istringstream lines(run_cleave({"verify", out()}).out);
    std::string found;
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("FAIL")) found += line + "\n";
    return found;
  }
  std::map<std::string, fs::file_time_type> manifest_times() const {
    std::map<std::string, fs::file_time_type> times;
    for (const auto& cell : fs::directory_iterator(out() / "cells"))
      if (fs::exists(cell.path() / "manifest.json"))
        times[cell.path().filename()] = fs::last_write_time(cell.path() / "manifest.json");
    return times;
  }
};

// A process group of its own, as a shell makes for a command.
struct Group {
  explicit Group(const Words& words) {
    process = ::fork();
    if (process == 0) {
      ::setpgid(0, 0);
      const pid_t sweep = start_cleave(words);
      ::signal(SIGINT, SIG_IGN);
      int status = 0;
      ::waitpid(sweep, &status, 0);
      ::_exit(WIFEXITED(status) ? WEXITSTATUS(status) : 99);
    }
    ::setpgid(process, process);
  }
  pid_t process;
  void send(int signal) const { ::kill(-process, signal); }
};

// As long as it lives, processes whose parent has ended are children of this one.
struct Adoption {
  Adoption() { ::prctl(PR_SET_CHILD_SUBREAPER, 1); }
  ~Adoption() { ::prctl(PR_SET_CHILD_SUBREAPER, 0); }
  // How the first process of a group ended, once all have: on a busy machine some take longer to die.
  static int finish(const Group& group) {
    const int code = finish_cleave(group.process);
    while (::waitpid(-group.process, nullptr, 0) > 0) continue;
    return code;
  }
};

std::vector<pid_t> children_of(pid_t process) {
  const std::string id = std::to_string(process);
  std::istringstream text(read_text("/proc/" + id + "/task/" + id + "/children"));
  std::vector<pid_t> found;
  for (pid_t child; text >> child;) found.push_back(child);
  return found;
}

void pause_ms(int milliseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds)); }

pid_t wait_for_child(pid_t process) {
  for (int k = 0; k < 5000; ++k, pause_ms(2))
    if (const auto children = children_of(process); !children.empty()) return children.front();
  return -1;
}

// The one process of a sweep's cell, once that has begun to run.
pid_t wait_for_cell(pid_t sweep, const fs::path& cells) {
  for (int k = 0; k < 5000; ++k, pause_ms(2)) {
    std::error_code none;
    for (const auto& cell : fs::directory_iterator(cells, none))
      if (fs::exists(cell.path() / "steps.csv"))
        if (const auto children = children_of(sweep); children.size() == 1) return children.front();
  }
  return -1;
}

bool is_gone(pid_t process) {
  for (int k = 0; k < 5000; ++k, pause_ms(2))
    if (::kill(process, 0) != 0) return true;
  return false;
}

void flip_byte(const fs::path& path, std::size_t place) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(static_cast<std::streamoff>(place));
  const char byte = static_cast<char>(file.get() ^ 4);
  file.seekp(static_cast<std::streamoff>(place));
  file.put(byte);
}

// Checksums made anew to match: what is left is what the files say of each other.
void seal_again(const fs::path& directory) {
  run_program("/bin/sh", {"-c", "cd '" + directory.string() +
                                    "' && sha256sum $(cut -c67- checksums) > new && mv new checksums"});
}

TEST(Sweep, RunsEveryCellAsRunDoes) {
  const Campaign campaign(std::string(kTiny) + "seed = [1, 2]\nthreads = [1, 2]\n");
  const ProgramResult result = campaign.sweep();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const CsvTable index = campaign.index();
  ASSERT_EQ(index.rows.size(), 4u);
  EXPECT_EQ(index.column("status"), Words(4, "ok"));
  EXPECT_EQ(index.column("number"), Words({"1", "2", "3", "4"}));
  EXPECT_EQ(index.column("rows"), Words(4, "2"));
  EXPECT_EQ(run_cleave({"run",
                        "--scene",
                        "rock_pile",
                        "--bodies",
                        "3",
                        "--steps",
                        "4",
                        "--measure-every",
                        "2",
                        "--repeats",
                        "1",
                        "--partitioner",
                        "mindp",
                        "--refiner",
                        "none",
                        "--solver",
                        "exact",
                        "--seed",
                        "2",
                        "--out",
                        campaign / "alone"})
                .exit_code,
            0);
  const CsvTable alone = read_csv(campaign / "alone/steps.csv"),
                 cell = read_csv(campaign.cell(2) / "steps.csv");
  for (const char* column : {"run_id", "seed", "step", "state_hash", "problem_hash", "solution_hash"})
    EXPECT_EQ(alone.column(column), cell.column(column)) << column;
  EXPECT_EQ(campaign.failures(), "");
}

TEST(Sweep, KeepsWhatIsCompleteAndForceDoesNot) {
  const Campaign campaign(std::string(kTiny) + "seed = [1, 2, 3]\n");
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  const auto times = campaign.manifest_times();
  fs::remove_all(campaign.cell(1));
  const ProgramResult again = campaign.sweep();
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.err.find("2 cells are done and kept\n"), std::string::npos) << again.err;
  EXPECT_NE(again.err.find("3 cells: 3 ok; 2 kept\n"), std::string::npos) << again.err;
  int changed = 0;
  for (const auto& [name, time] : campaign.manifest_times()) changed += time != times.at(name);
  EXPECT_EQ(changed, 1);
  // Without the index the cells themselves say what is done.
  fs::remove(campaign.out() / "index.csv");
  EXPECT_NE(campaign.sweep().err.find("3 ok; 3 kept\n"), std::string::npos);
  EXPECT_NE(campaign.sweep({"--force"}).err.find("3 ok; 0 kept\n"), std::string::npos);
  EXPECT_EQ(campaign.failures(), "");
}

TEST(Sweep, ARunOfItsOwnDoesNotGoIntoACampaign) {
  const Campaign campaign(std::string(kTiny) + "seed = [1]\n");
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  const std::string checksums = read_text(campaign.out() / "checksums");
  for (const char* force : {"--gravity=9.81", "--force"}) {
    const ProgramResult run = run_cleave({"run", "--scene", "ladder_free", "--steps", "1", "--solver",
                                          "exact", force, "--out", campaign.out()});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.err.find("holds a campaign; name another directory"), std::string::npos) << run.err;
  }
  EXPECT_EQ(read_text(campaign.out() / "checksums"), checksums);
  EXPECT_NE(campaign.sweep().err.find("1 ok; 1 kept\n"), std::string::npos);
}

TEST(Sweep, ADamagedIndexIsNotBelieved) {
  const Campaign campaign(std::string(kTiny) + "seed = [1, 2]\n");
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  std::string text = read_text(campaign.out() / "index.csv");
  text.replace(text.find(",ok,"), 4, ",ko,");
  std::ofstream(campaign.out() / "index.csv") << text;
  EXPECT_EQ(campaign.sweep().exit_code, 0);
  EXPECT_EQ(campaign.index().column("status"), Words(2, "ok"));
  EXPECT_EQ(campaign.failures(), "");
}

TEST(Sweep, ACellIsDoneAgainWhereItsFilesAreNotThose) {
  const Campaign campaign(std::string(kTiny) + "seed = [1, 2]\n");
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  fs::remove(campaign.cell(0) / "checksums");
  EXPECT_NE(campaign.sweep().err.find("2 ok; 1 kept\n"), std::string::npos);
  flip_byte(campaign.cell(1) / "steps.csv", 3000);
  fs::remove(campaign.out() / "index.csv");
  EXPECT_NE(campaign.sweep().err.find("2 ok; 1 kept\n"), std::string::npos);
  EXPECT_EQ(campaign.failures(), "");
}

// As a run leaves it that was killed after its last file.
TEST(Sweep, ALockThatNobodyHoldsGoesFromACompleteCell) {
  const Campaign campaign(kTiny);
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  std::ofstream(campaign.cell() / "cleave.lock") << "";
  EXPECT_NE(campaign.failures(), "");
  EXPECT_NE(campaign.sweep().err.find("1 kept\n"), std::string::npos);
  EXPECT_EQ(campaign.failures(), "");
}

// The index of a build with local changes names the program itself; here it is as if another one had been
// there.
TEST(Sweep, CellsOfAnotherBuildRunAgainAndThatIsSaid) {
  const Campaign campaign(kTiny);
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  std::string manifest = read_text(campaign.cell() / "manifest.json");
  const std::size_t flags = manifest.find("\"flags\": \"") + 10;
  manifest.insert(flags, "-O0 ");
  std::ofstream(campaign.cell() / "manifest.json") << manifest;
  seal_again(campaign.cell());
  std::string index = read_text(campaign.out() / "index.csv");
  const std::string build = campaign.index().at(0, "build");
  index.replace(index.find(build), build.size(), "0123456789abcdef");
  std::ofstream(campaign.out() / "index.csv") << index;
  seal_again(campaign.out());
  const ProgramResult result = campaign.sweep();
  EXPECT_NE(result.err.find("1 cells are of another build and run again\n"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("1 ok; 0 kept\n"), std::string::npos) << result.err;
  EXPECT_EQ(campaign.index().at(0, "build"), build);
}

TEST(Sweep, CellsAreBoundToCores) {
  const Campaign campaign(kTiny);
  ASSERT_EQ(campaign.sweep({"--pin", "1"}).exit_code, 0);
  EXPECT_NE(read_text(campaign.cell() / "manifest.json").find("\"cores\": 1,"), std::string::npos);
  campaign.write_spec(std::string(kTiny) + "threads = 2\n");
  EXPECT_NE(campaign.sweep({"--pin", "1"}).err.find("--pin: 1 is less than the 2 threads of cell "),
            std::string::npos);
}

TEST(Sweep, ADryRunPrintsCellsAndCreatesNothing) {
  const Campaign campaign(std::string(kTiny) + "seed = [1, 2]\n");
  const ProgramResult before = campaign.sweep({"--dry-run"});
  EXPECT_EQ(before.exit_code, 0);
  EXPECT_FALSE(fs::exists(campaign.out()));
  EXPECT_EQ(before.err, "2 cells: 0 done, 2 to do\n");
  const CsvTable cells = parse_csv(before.out);
  EXPECT_EQ(cells.column("status"), Words(2, "pending"));
  EXPECT_EQ(cells.column("about_s"), Words(2, "nan"));
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  campaign.write_spec(std::string(kTiny) + "seed = [1, 2, 9]\n");
  const auto times = campaign.manifest_times();
  const ProgramResult after = campaign.sweep({"--dry-run"});
  EXPECT_EQ(parse_csv(after.out).column("status"), Words({"ok", "ok", "pending"}));
  const double about_s = std::stod(parse_csv(after.out).at(2, "about_s"));
  EXPECT_GT(about_s, 0);
  EXPECT_TRUE(after.err.starts_with("3 cells: 2 done, 1 to do, about " + seconds_text(about_s) + "\n"))
      << after.err;
  EXPECT_EQ(campaign.manifest_times(), times);
}

TEST(Sweep, AChangedSpecRunsWhatIsNewAndKeepsWhatIsOld) {
  const Campaign campaign(std::string(kTiny) + "seed = [1, 2]\n");
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  campaign.write_spec(std::string(kTiny) + "seed = [2, 3]\n");
  const ProgramResult result = campaign.sweep();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("1 cells of an earlier spec are not in this one; they stay\n"), std::string::npos)
      << result.err;
  EXPECT_EQ(campaign.index().column("number"), Words({"1", "2", "0"}));
  EXPECT_EQ(campaign.manifest_times().size(), 3u);
  EXPECT_EQ(campaign.failures(), "");
  const ProgramResult collected = run_cleave({"collect", campaign.out(), "--out", campaign / "all.csv"});
  EXPECT_NE(collected.err.find("out: 1 cells are of an earlier spec, and their rows are taken too\n"),
            std::string::npos)
      << collected.err;
}

// A campaign that was killed between its index and their checksums: what its directories vouch for stays
// known.
TEST(Sweep, AFailedCellOfAnEarlierSpecStaysWhereTheIndexHasNoChecksums) {
  const Campaign campaign(std::string(kEndless) + "[[include]]\nsteps = 4\nmeasure-every = 2\n");
  ASSERT_EQ(campaign.sweep({"--cell-seconds", "0.5"}).exit_code, 2);
  fs::remove(campaign.out() / "checksums");
  campaign.write_spec(std::string(kTiny) + "seed = 2\n");
  EXPECT_EQ(campaign.sweep().exit_code, 0);
  EXPECT_EQ(campaign.index().column("number"), Words({"1", "0", "0"}));
  EXPECT_EQ(campaign.index().column("status"), Words({"ok", "timeout", "ok"}));
  EXPECT_EQ(campaign.failures(), "");
}

TEST(Sweep, RowsThatAreNotOkAreARowOfTheIndex) {
  const Campaign campaign(
      std::string(kTiny) +
      "sweeps = 1\n[[include]]\nsolver = 'pgs'\nbodies = 12\nsteps = 80\nmeasure-every = 40\n");
  // The first cell has nothing that sweeps: refused before anything is created.
  EXPECT_EQ(campaign.sweep().exit_code, 1);
  EXPECT_FALSE(fs::exists(campaign.out()));
  campaign.write_spec(std::string(kTiny) +
                      "[[include]]\nsolver = 'pgs@sweeps=1'\nbodies = 12\nsteps = 80\nmeasure-every = 40\n");
  const ProgramResult result = campaign.sweep();
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(campaign.index().column("status"), Words({"ok", "not_converged"}));
  EXPECT_NE(result.err.find(": not_converged, "), std::string::npos) << result.err;
  EXPECT_EQ(campaign.failures(), "");
  EXPECT_NE(campaign.sweep().err.find("2 kept\n"), std::string::npos);
}

TEST(Sweep, ACellThatTakesTooLongIsARowAndTheCampaignGoesOn) {
  const Campaign campaign(std::string(kEndless) + "[[include]]\nsteps = 4\nmeasure-every = 2\n");
  const ProgramResult result = campaign.sweep({"--cell-seconds", "0.5"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(campaign.index().column("status"), Words({"timeout", "ok"}));
  EXPECT_NE(read_text(campaign.log()).find("reason: took longer than 0.5 s\n"), std::string::npos);
  EXPECT_EQ(campaign.failures(), "");
  EXPECT_NE(campaign.sweep({"--keep-failed"}).err.find("2 kept\n"), std::string::npos);
  EXPECT_NE(campaign.sweep({"--cell-seconds", "0.4"}).err.find("1 kept\n"), std::string::npos);
}

TEST(Sweep, ACellThatStopsForNobodyIsKilled) {
  const Campaign campaign(kEndless);
  const pid_t sweep = start_cleave(campaign.words({"--cell-seconds", "1"}));
  const pid_t cell = wait_for_cell(sweep, campaign.out() / "cells");
  ASSERT_GT(cell, 0);
  ::kill(cell, SIGSTOP);
  EXPECT_EQ(finish_cleave(sweep), 2);
  EXPECT_TRUE(is_gone(cell));
  EXPECT_EQ(campaign.index().column("status"), Words({"timeout"}));
  EXPECT_NE(read_text(campaign.log()).find("end: ended by SIGKILL\n"), std::string::npos);
}

TEST(Sweep, ACrashIsARowAndTheCampaignGoesOn) {
  for (const auto& [signal, name] :
       {std::pair(SIGABRT, "SIGABRT"), std::pair(SIGSEGV, "SIGSEGV"), std::pair(SIGKILL, "SIGKILL")}) {
    const Campaign campaign(std::string(kEndless) + "[[include]]\nsteps = 4\nmeasure-every = 2\n");
    const pid_t sweep = start_cleave(campaign.words({}));
    const pid_t cell = wait_for_cell(sweep, campaign.out() / "cells");
    ASSERT_GT(cell, 0);
    ::kill(cell, signal);
    EXPECT_EQ(finish_cleave(sweep), 2);
    EXPECT_EQ(campaign.index().column("status"), Words({"crashed", "ok"}));
    EXPECT_EQ(campaign.index().at(0, "reason"), std::string("ended by ") + name);
    EXPECT_NE(read_text(campaign.log()).find("status: crashed\n"), std::string::npos);
    EXPECT_EQ(campaign.failures(), "");
    // It is tried again, and the log of the first attempt goes.
    EXPECT_EQ(campaign.sweep({"--cell-seconds", "0.5"}).exit_code, 2);
    EXPECT_EQ(campaign.index().column("status"), Words({"timeout", "ok"}));
    EXPECT_EQ(campaign.failures(), "");
  }
}

TEST(SweepMemory, ACellWithoutMemoryIsARow) {
  const Campaign campaign(std::string(kTiny) + "[[include]]\nbodies = 20000\n");
  const ProgramResult result = campaign.sweep({"--cell-memory-gb", "0.08"});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(campaign.index().column("status"), Words({"ok", "out_of_memory"})) << result.err;
  EXPECT_EQ(campaign.failures(), "");
}

TEST(Sweep, AnInterruptReachesTheCellAndIsResumed) {
  const Campaign campaign(std::string(kEndless) + "seed = [1, 2]\n");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const pid_t sweep = start_cleave(campaign.words({}));
    const pid_t cell = wait_for_cell(sweep, campaign.out() / "cells");
    ASSERT_GT(cell, 0);
    ::kill(sweep, signal);
    if (signal == SIGHUP) ::kill(sweep, signal);  // a terminal that is closed hangs up twice
    EXPECT_EQ(finish_cleave(sweep), 130);
    EXPECT_TRUE(is_gone(cell));
    EXPECT_EQ(campaign.index().column("status"), Words(2, "pending"));
    EXPECT_FALSE(fs::exists(campaign.out() / "failed"));
    EXPECT_FALSE(fs::exists(campaign.out() / "cleave.lock"));
    EXPECT_NE(read_text(campaign.cell() / "manifest.json").find("\"state\": \"interrupted\""),
              std::string::npos);
    fs::remove(campaign.cell() / "steps.csv");  // which the next wait looks for
  }
  EXPECT_NE(campaign.failures().find("pending: the campaign is incomplete"), std::string::npos);
}

// The keyboard sends it to the whole group; a cell that got two would end without its last word.
TEST(Sweep, AnInterruptOfTheGroupReachesACellOnce) {
  const Campaign campaign(kEndless);
  const Group group(campaign.words({}));
  const pid_t sweep = wait_for_child(group.process);
  ASSERT_GT(wait_for_cell(sweep, campaign.out() / "cells"), 0);
  group.send(SIGINT);
  EXPECT_EQ(finish_cleave(group.process), 130);
  EXPECT_NE(read_text(campaign.cell() / "manifest.json").find("\"state\": \"interrupted\""),
            std::string::npos);
}

TEST(Sweep, ASecondSignalEndsItAndItsCellsAtOnce) {
  const Campaign campaign(kEndless);
  const pid_t sweep = start_cleave(campaign.words({}));
  const pid_t cell = wait_for_cell(sweep, campaign.out() / "cells");
  ASSERT_GT(cell, 0);
  ::kill(cell, SIGSTOP);
  ::kill(sweep, SIGINT);
  pause_ms(300);
  ::kill(sweep, SIGTERM);
  EXPECT_EQ(finish_cleave(sweep), 128 + SIGTERM);
  EXPECT_TRUE(is_gone(cell));
}

TEST(Sweep, DoesNotKeepWhatItIsToRunAnew) {
  const Campaign campaign(kEndless);
  const ProgramResult refused = campaign.sweep({"--force", "--keep-failed"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("--keep-failed: keeps cells, and --force runs all anew; leave out one of them"),
            std::string::npos)
      << refused.err;
}

TEST(Sweep, OneProcessAtATimeHoldsADirectory) {
  const Campaign campaign(kEndless);
  const pid_t sweep = start_cleave(campaign.words({}));
  const pid_t cell = wait_for_cell(sweep, campaign.out() / "cells");
  ASSERT_GT(cell, 0);
  const ProgramResult second = campaign.sweep();
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_NE(second.err.find("is being written by process " + std::to_string(sweep)), std::string::npos)
      << second.err;
  // A share of the same campaign has a lock of its own, and leaves the cell to who runs it.
  const ProgramResult share = campaign.sweep({"--shard", "1/2"});
  EXPECT_EQ(share.exit_code, 2);  // not done, by whomever
  EXPECT_NE(share.err.find("1 cells: 1 pending; 0 kept, 1 run by another process"), std::string::npos)
      << share.err;
  ::kill(sweep, SIGTERM);
  EXPECT_EQ(finish_cleave(sweep), 130);
}

// What a kill at any moment leaves is completed: every cell once, nothing damaged, nobody left behind.
TEST(Sweep, GoesOnAfterKillsAtRandomMoments) {
  constexpr int kCells = 24;
  const Adoption adoption;
  for (const unsigned seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Campaign campaign(std::string(kTiny) + "seed = { from = 1, to = 12, step = 1 }\nrounds = 2\n");
    int kills = 0;
    for (int attempt = 0; attempt < 12; ++attempt) {
      const Group group(campaign.words(attempt % 2 == 0 ? Words{} : Words{"--jobs", "3"}));
      pause_ms(static_cast<int>(random() % 250));
      group.send(SIGKILL);
      kills += adoption.finish(group) == 128 + SIGKILL;
    }
    EXPECT_GT(kills, 3);
    const ProgramResult last = campaign.sweep();
    EXPECT_EQ(last.exit_code, 0) << last.err;
    const CsvTable index = campaign.index();
    EXPECT_EQ(index.column("status"), Words(kCells, "ok"));
    const Words names = index.column("cell");
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), static_cast<std::size_t>(kCells));
    EXPECT_EQ(campaign.manifest_times().size(), static_cast<std::size_t>(kCells));
    for (const std::string& name : names)
      EXPECT_EQ(read_csv(campaign.out() / "cells" / name / "steps.csv").rows.size(), 2u);
    EXPECT_EQ(campaign.failures(), "");
    EXPECT_FALSE(fs::exists(campaign.out() / "cleave.lock"));
  }
}

TEST(Sweep, SharesMakeTheWholeSideBySide) {
  const Campaign campaign(std::string(kTiny) + "seed = { from = 1, to = 10, step = 1 }\n");
  std::vector<pid_t> shares;
  for (const char* share : {"1/3", "2/3", "3/3"})
    shares.push_back(start_cleave(campaign.words({"--shard", share})));
  for (const pid_t share : shares) EXPECT_EQ(finish_cleave(share), 0);
  EXPECT_EQ(campaign.failures(), "");
  std::set<std::string> cells;
  for (const char* share : {"1of3", "2of3", "3of3"})
    for (const std::string& name : read_csv(campaign.out() / "shards" / share / "index.csv").column("cell"))
      EXPECT_TRUE(cells.insert(name).second);
  EXPECT_EQ(cells.size(), 10u);
  EXPECT_EQ(read_csv(campaign.out() / "shards/2of3/index.csv").column("number"), Words({"2", "5", "8"}));
  // All of it at once finds everything done.
  EXPECT_NE(campaign.sweep().err.find("10 ok; 10 kept\n"), std::string::npos);
  EXPECT_EQ(campaign.failures(), "");
}

TEST(Sweep, AFullDiskEndsItInOneLineAndIsResumed) {
  const Campaign campaign(std::string(kTiny) + "seed = { from = 1, to = 50, step = 1 }\n");
  const std::string disk = campaign / "disk";
  fs::create_directory(disk);
  if (run_program("/bin/mount", {"-t", "tmpfs", "-o", "size=600k", "tmpfs", disk}).exit_code != 0)
    GTEST_SKIP() << "no disk of a small size can be mounted here";
  const Words words = {"sweep", campaign.spec(), "--out", disk + "/out", "--quiet"};
  const ProgramResult result = run_cleave(words);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.err.find("No space left on device"), std::string::npos) << result.err;
  EXPECT_EQ(count_lines(result.err), 1) << result.err;
  EXPECT_EQ(run_program("/bin/mount", {"-o", "remount,size=100m", disk}).exit_code, 0);
  const ProgramResult again = run_cleave(words);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_csv(disk + "/out/index.csv").column("status"), Words(50, "ok"));
  EXPECT_EQ(run_cleave({"verify", disk + "/out"}).exit_code, 0);
  EXPECT_EQ(run_program("/bin/umount", {disk}).exit_code, 0);
}

TEST(Sweep, BadInputIsOneLineAndCreatesNothing) {
  const Campaign campaign(kTiny);
  const std::pair<Words, std::string> wrong[] = {
      {{"--jobs", "0"}, "--jobs: 0 is not in [1, 1024]"},
      {{"--jobs", "1024", "--pin", "1"}, "--pin: 1 cores for each of --jobs 1024 are more than the "},
      {{"--pin", "100000"}, "--pin: 100000 is not in [0, "},
      {{"--shard", "2"}, "--shard: '2' is not of the form i/n"},
      {{"--shard", "3/2"}, "--shard i: 3 is not in [1, 2]"},
      {{"--shard", "0/2"}, "--shard i: 0 is not in [1, 2]"},
      {{"--shard", "2/2"}, "--shard: share 2 of 2 has none of the 1 cells"},
      {{"--cell-seconds", "0"}, "--cell-seconds: 0 is not in (0, inf)"},
      {{"--cell-memory-gb", "x"}, "--cell-memory-gb: 'x' is not a number in (0, inf)"},
      {{"--job", "2"}, "--job: no such option (did you mean --jobs?)"},
  };
  for (const auto& [words, error] : wrong) {
    const ProgramResult result = campaign.sweep(words);
    EXPECT_EQ(result.exit_code, 1) << error;
    EXPECT_NE(result.err.find("cleave sweep: " + error), std::string::npos) << result.err;
    EXPECT_EQ(count_lines(result.err), 1);
    EXPECT_FALSE(fs::exists(campaign.out())) << error;
  }
  EXPECT_EQ(run_cleave({"sweep", campaign.spec()}).exit_code, 1);
  EXPECT_EQ(run_cleave({"sweep", "--out", campaign.out()}).exit_code, 1);
  EXPECT_EQ(run_cleave({"sweep", campaign / "none.toml", "--out", campaign.out()}).exit_code, 1);
  EXPECT_FALSE(fs::exists(campaign.out()));
}

TEST(Sweep, ADirectoryOfSomethingElseIsRefused) {
  const Campaign campaign(kTiny);
  fs::create_directory(campaign.out());
  std::ofstream(campaign.out() / "manifest.json") << "{}";
  EXPECT_NE(campaign.sweep().err.find("is the output directory of a run and no campaign"), std::string::npos);
  fs::remove(campaign.out() / "manifest.json");
  std::ofstream(campaign.out() / "index.csv") << "cell,colour\n";
  EXPECT_NE(campaign.sweep().err.find("its columns are not those of a campaign of this version"),
            std::string::npos);
}

TEST(Sweep, QuietSaysNothingWhereAllIsWell) {
  const Campaign campaign(kTiny);
  const ProgramResult result = campaign.sweep({"--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err + result.out, "");
}

// Of the rows of a table of harness/README.md.
std::vector<std::string> first_cells(const std::string& head) {
  std::istringstream readme(read_text(fs::path(CLEAVE_SOURCE_DIR) / "harness/README.md"));
  std::vector<std::string> cells;
  std::string line;
  while (std::getline(readme, line) && !line.starts_with(head)) continue;
  while (std::getline(readme, line) && line.starts_with("|"))
    if (!line.starts_with("|---")) cells.push_back(line.substr(2, line.find(" |", 2) - 2));
  return cells;
}

TEST(Sweep, ClocksThatJumpChangeNothing) {
  const Campaign campaign(std::string(kTiny) + "seed = [1, 2, 3, 4, 5, 6]\n");
  Words words = campaign.words({});
  words.insert(words.begin(), {std::string("LD_PRELOAD=") + CLEAVE_JUMPING_CLOCK, CLEAVE_PROGRAM});
  const auto sweep = [&] { return run_program("/usr/bin/env", words); };
  EXPECT_EQ(sweep().exit_code, 0);
  std::set<std::string> days;
  for (const std::string& moment : campaign.index().column("utc_start")) days.insert(moment.substr(0, 10));
  EXPECT_GT(days.size(), 1u) << "the clock did not jump";
  const auto times = campaign.manifest_times();
  for (const auto& [cell, time] : times)
    fs::last_write_time(campaign.out() / "cells" / cell / "manifest.json",
                        time + std::chrono::hours(cell < times.rbegin()->first ? 100000 : -100000));
  EXPECT_NE(sweep().err.find("6 ok; 6 kept\n"), std::string::npos);
  EXPECT_EQ(campaign.failures(), "");
}

TEST(SweepVerify, FindsEveryDamagedByteOfACampaign) {
  const Campaign campaign(std::string(kEndless) + "[[include]]\nsteps = 4\nmeasure-every = 2\n");
  ASSERT_EQ(campaign.sweep({"--cell-seconds", "0.3"}).exit_code, 2);
  ASSERT_EQ(campaign.failures(), "");
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(campaign.out()))
    if (entry.is_regular_file()) files.push_back(entry.path());
  EXPECT_GE(files.size(), 10u);
  std::mt19937 random(5);
  for (const fs::path& file : files)
    for (int trial = 0; trial < 8; ++trial) {
      const std::size_t place = random() % fs::file_size(file);
      flip_byte(file, place);
      EXPECT_EQ(run_cleave({"verify", campaign.out()}).exit_code, 3) << file << " byte " << place;
      flip_byte(file, place);
    }
  EXPECT_EQ(campaign.failures(), "");
}

// The tables that the last job of a cluster leaves, and those that a user puts beside the index.
TEST(SweepVerify, LooksAtTheMergedTables) {
  const Campaign campaign(kTiny);
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  fs::create_directory(campaign.out() / "slurm");
  for (const char* name : {"results.csv", "slurm/results.csv"}) {
    SCOPED_TRACE(name);
    const fs::path table = campaign.out() / name;
    ASSERT_EQ(run_cleave({"collect", campaign.out(), "--out", table}).exit_code, 0);
    EXPECT_EQ(campaign.failures(), "");
    flip_byte(table, 1000);
    EXPECT_NE(campaign.failures().find(std::string(name) + ": sha256 "), std::string::npos);
    flip_byte(table, 1000);
  }
  fs::remove(campaign.out() / "results.csv");
  EXPECT_NE(campaign.failures().find("results.cells.csv is not of this run"), std::string::npos);
}

TEST(SweepVerify, FindsAnIndexThatSaysSomethingElse) {
  const Campaign campaign(std::string(kTiny) + "seed = [1, 2]\n");
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  const fs::path index = campaign.out() / "index.csv";
  const std::string good = read_text(index);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    std::ofstream(index) << text;
    seal_again(campaign.out());
    return campaign.failures();
  };
  EXPECT_NE(with(",ok,-,2,2,", ",ok,-,3,3,").find("is as the index says; its directory gives "),
            std::string::npos);
  EXPECT_NE(with(",ok,-,", ",diverged,-,").find("is as the index says"), std::string::npos);
  EXPECT_NE(with("--seed=1", "--seed=7").find("line 2 is not cell 1 of it"), std::string::npos);
  EXPECT_NE(with(",1,", ",5,").find("line 2 is not cell 1 of it"), std::string::npos);
  std::string fewer = good;
  fewer.erase(fewer.rfind('\n', fewer.size() - 2) + 1);
  std::ofstream(index) << fewer;
  seal_again(campaign.out());
  EXPECT_NE(campaign.failures().find("it has another number of cells"), std::string::npos);
  std::ofstream(index) << good;
  seal_again(campaign.out());
  EXPECT_EQ(campaign.failures(), "");
}

// Each check of the table in harness/README.md is broken here.
TEST(SweepVerify, EveryCheckOfTheTableCanFail) {
  struct Breakage {
    std::string check, failure;
    std::function<void(const Campaign&)> spoil;
  };
  const Breakage breakages[] = {
      {"nothing else", "1of2 has no index",
       [](const Campaign& c) { fs::create_directories(c.out() / "shards/1of2"); }},
      {"index", "index.csv: is missing", [](const Campaign& c) { fs::remove(c.out() / "index.csv"); }},
      {"rows of the index", "index.csv: readable; ",
       [](const Campaign& c) {
         std::ofstream(c.out() / "index.csv", std::ios::app) << "a,b\n";
         seal_again(c.out());
       }},
      {"cells of the spec", "has the cells of spec.toml; it has another number of cells",
       [](const Campaign& c) {
         std::ofstream(c.out() / "spec.toml") << kTiny << "seed = [1, 2, 3]\n";
         seal_again(c.out());
       }},
      {"ended", "pending: the campaign is incomplete",
       [](const Campaign& c) {
         fs::remove_all(c.cell());
         std::string text = read_text(c.out() / "index.csv");
         text.replace(text.find(",ok,"), 4, ",pending,");
         std::ofstream(c.out() / "index.csv") << text;
         seal_again(c.out());
       }},
      {"vouched for", "is not that of the index",
       [](const Campaign& c) { fs::rename(c.cell(1), c.path() / "moved"); }},
      {"row of a cell", "is as the index says; its directory gives ",
       [](const Campaign& c) {
         std::string text = read_text(c.out() / "index.csv");
         text.replace(text.find(",ok,-,2,2,"), 10, ",ok,-,3,3,");
         std::ofstream(c.out() / "index.csv") << text;
         seal_again(c.out());
       }},
      {"names", "other is in no index",
       [](const Campaign& c) { fs::create_directory(c.out() / "cells/other"); }},
  };
  std::vector<std::string> broken;
  for (const Breakage& breakage : breakages) {
    const Campaign campaign(std::string(kTiny) + "seed = [1, 2]\n");
    ASSERT_EQ(campaign.sweep().exit_code, 0);
    breakage.spoil(campaign);
    EXPECT_NE(campaign.failures().find(breakage.failure), std::string::npos) << breakage.check << " says:\n"
                                                                             << campaign.failures();
    broken.push_back(breakage.check);
  }
  EXPECT_EQ(broken, first_cells("| check of a campaign |"));
  const std::string text = read_text(fs::path(CLEAVE_SOURCE_DIR) / "harness/commands/verify_campaign.cpp");
  std::size_t calls = 0;
  for (std::size_t at = text.find("list.add("); at != std::string::npos; at = text.find("list.add(", at + 1))
    ++calls;
  EXPECT_EQ(calls, broken.size());
}

// A campaign that was killed has its lock still; its cells are looked at none the less.
TEST(SweepVerify, LooksAtTheCellsOfAKilledCampaign) {
  const Campaign campaign(std::string(kTiny) +
                          "[[include]]\nsteps = 100000000\nmeasure-every = 100000000\nsolver = 'schur'\n");
  const Adoption adoption;
  const Group group(campaign.words({}));
  for (int k = 0;
       k < 5000 && (!fs::exists(campaign.out() / "index.csv") || campaign.index().at(0, "status") != "ok");
       ++k)
    pause_ms(5);
  pause_ms(200);  // an index and its checksums appear one after the other
  group.send(SIGKILL);
  adoption.finish(group);
  ASSERT_TRUE(fs::exists(campaign.out() / "cleave.lock"));
  const ProgramResult result = run_cleave({"verify", campaign.out()});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(campaign.failures(),
            "FAIL  " + campaign.cell(1).string() + ": pending: the campaign is incomplete\n");
  EXPECT_NE(result.out.find("ok    " + (campaign.cell(0) / "steps.csv").string()), std::string::npos)
      << result.out;
}

TEST(SweepVerify, NamesFilesAndLogsThatNobodyKnows) {
  const Campaign campaign(std::string(kTiny) + "seed = [1, 2]\n");
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  std::ofstream(campaign.out() / "note.txt") << "x";
  EXPECT_NE(campaign.failures().find("note.txt is not of this run"), std::string::npos);
  fs::remove(campaign.out() / "note.txt");
  fs::create_directory(campaign.out() / "failed");
  std::ofstream(campaign.log()) << "x";
  EXPECT_NE(campaign.failures(), "");
  fs::remove_all(campaign.out() / "failed");
  EXPECT_EQ(campaign.failures(), "");
}

TEST(CampaignIndex, EveryColumnIsInTheReadme) {
  std::vector<std::string> listed;
  static const std::regex name("`([a-z_]+)`");
  for (const std::string& cell : first_cells("| column of `index.csv` |"))
    for (std::sregex_iterator match(cell.begin(), cell.end(), name), end; match != end; ++match)
      listed.push_back((*match)[1]);
  std::vector<std::string> columns;
  visit_index(IndexRow(), [&](const char* column, const auto&) { columns.push_back(column); });
  EXPECT_EQ(listed, columns);
}

// A host died with a task on it: its locks stay, on the share and on a cell.
TEST(Sweep, TakesOverWhatADeadHostLeftWhereThatIsAskedFor) {
  const Campaign campaign(std::string(kTiny) + "seed = [1, 2, 3]\n");
  ASSERT_EQ(campaign.sweep({"--shard", "1/2"}).exit_code, 0);
  const fs::path share = campaign.out() / "shards/1of2";
  const fs::path cell = campaign.out() / "cells" / read_csv(share / "index.csv").at(1, "cell");
  const std::string left = "host: elsewhere\npid: 12\nstart: now\ncommand: cleave sweep\n";
  fs::remove(cell / "checksums");
  for (const fs::path& directory : {share, cell}) std::ofstream(directory / "cleave.lock") << left;

  const ProgramResult refused = campaign.sweep({"--shard", "1/2"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("was left by process 12 on host elsewhere"), std::string::npos) << refused.err;
  const ProgramResult taken = campaign.sweep({"--shard", "1/2", "--take-over"});
  EXPECT_EQ(taken.exit_code, 0) << taken.err;
  EXPECT_NE(taken.err.find("2 cells: 2 ok; 1 kept"), std::string::npos) << taken.err;
  for (const fs::path& directory : {share, cell}) EXPECT_FALSE(fs::exists(directory / "cleave.lock"));
}

TEST(Sweep, MergesSharesWithoutRunningAnything) {
  const Campaign campaign(std::string(kTiny) + "seed = [1, 2, 3]\n");
  ASSERT_EQ(campaign.sweep({"--shard", "1/2"}).exit_code, 0);
  const ProgramResult half = campaign.sweep({"--merge"});
  EXPECT_EQ(half.exit_code, 2);
  EXPECT_NE(half.err.find("3 cells: 2 ok, 1 pending; 2 kept"), std::string::npos) << half.err;
  const CsvTable missing = parse_csv(half.out);
  EXPECT_EQ(missing.column("number"), Words({"2"}));
  EXPECT_EQ(missing.column("status"), Words({"pending"}));
  EXPECT_EQ(campaign.index().column("status"), Words({"ok", "pending", "ok"}));

  ASSERT_EQ(campaign.sweep({"--shard", "2/2"}).exit_code, 0);
  const auto times = campaign.manifest_times();
  const ProgramResult whole = campaign.sweep({"--merge"});
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_TRUE(parse_csv(whole.out).rows.empty()) << whole.out;
  EXPECT_EQ(campaign.index().column("status"), Words(3, "ok"));
  EXPECT_EQ(campaign.manifest_times(), times);
  fs::create_directory(campaign.out() / "slurm");  // job files, which are no results
  EXPECT_EQ(campaign.failures(), "");
  fs::remove(campaign.out() / "index.csv");
  fs::remove(campaign.out() / "spec.toml");
  fs::remove(campaign.out() / "checksums");
  EXPECT_EQ(campaign.failures(), "");

  for (const Words& words : {Words{"--shard", "1/2"}, Words{"--force"}, Words{"--dry-run"},
                             Words{"--keep-failed"}, Words{"--jobs", "2"}, Words{"--pin", "1"},
                             Words{"--cell-seconds", "9"}, Words{"--cell-memory-gb", "9"}}) {
    Words more = {"--merge"};
    more.insert(more.end(), words.begin(), words.end());
    const ProgramResult refused = campaign.sweep(more);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("--merge: "), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("leave out " + words.front()), std::string::npos) << refused.err;
  }
}

// A merge looks at what failed and does not try it again.
TEST(Sweep, MergesFailuresAsTheyAre) {
  const Campaign campaign(std::string(kEndless) + "seed = [1, 2]\n");
  ASSERT_EQ(campaign.sweep({"--shard", "1/2", "--cell-seconds", "0.2"}).exit_code, 2);
  const ProgramResult merged = campaign.sweep({"--merge"});
  EXPECT_EQ(merged.exit_code, 2);
  EXPECT_EQ(parse_csv(merged.out).column("status"), Words({"timeout", "pending"}));
}

TEST(Rerun, RepeatsACellAndHoldsItsRowsAgainstIt) {
  const Campaign campaign(kTiny);
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  const fs::path cell = campaign.cell();
  EXPECT_EQ(run_cleave({"rerun", cell}).exit_code, 0);
  EXPECT_EQ(run_cleave({"rerun", cell, "--force"}).exit_code, 1);  // takes away what is nowhere
  const ProgramResult kept = run_cleave({"rerun", cell, "--threads", "2", "--out", campaign / "again"});
  EXPECT_EQ(kept.exit_code, 0) << kept.err;
  EXPECT_TRUE(kept.out.starts_with("ok    ")) << kept.out;
  EXPECT_EQ(read_csv(campaign / "again/steps.csv").column("threads"), Words(2, "2"));
  EXPECT_EQ(run_cleave({"rerun", cell, "--out", campaign / "again"}).exit_code, 1);  // holds one already
  EXPECT_EQ(run_cleave({"rerun", cell, "--out", campaign / "again", "--force"}).exit_code, 0);
  EXPECT_NE(run_cleave({"rerun", cell, "--out", cell, "--force"}).err.find("which is read"),
            std::string::npos);

  std::string text = read_text(cell / "steps.csv");
  const std::string hash = read_csv(cell / "steps.csv").at(1, "state_hash");
  text.replace(text.rfind(hash), hash.size(), "0123456789abcdef");
  std::ofstream(cell / "steps.csv") << text;
  const ProgramResult changed = run_cleave({"rerun", cell});
  EXPECT_EQ(changed.exit_code, 3);
  EXPECT_NE(changed.out.find("line 3: state_hash = '0123456789abcdef', again '" + hash + "'"),
            std::string::npos)
      << changed.out;
  text.erase(text.rfind('\n', text.size() - 2) + 1);
  std::ofstream(cell / "steps.csv") << text;
  EXPECT_NE(run_cleave({"rerun", cell}).out.find("it has 1, again 2"), std::string::npos);
}

// What the manifest knows by its content is named again, and only then is the run the same.
TEST(Rerun, WantsTheFilesThatARunHasRead) {
  const TemporaryDirectory directory;
  const std::string scene = "file@path=" + std::string(CLEAVE_SOURCE_DIR) + "/scenarios/files/pile.toml";
  ASSERT_EQ(run_cleave({"run", "--scene", scene, "--steps", "4", "--measure-every", "2", "--repeats", "1",
                        "--solver", "exact", "--out", directory / "run"})
                .exit_code,
            0);
  const ProgramResult without = run_cleave({"rerun", directory / "run"});
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_NE(without.err.find("--scene: is required"), std::string::npos) << without.err;
  const ProgramResult with = run_cleave({"rerun", directory / "run", "--scene", scene});
  EXPECT_EQ(with.exit_code, 0) << with.err;
  EXPECT_TRUE(with.out.starts_with("ok    ")) << with.out;
  const ProgramResult verified = run_cleave({"verify", directory / "run", "--rerun", "1"});
  EXPECT_EQ(verified.exit_code, 0) << verified.err;
  EXPECT_NE(verified.err.find("is not repeated, as it read files"), std::string::npos) << verified.err;
  EXPECT_NE(verified.err.find(" checks, 0 failed"), std::string::npos) << verified.err;
}

TEST(Rerun, RefusesWhatIsNoCompleteRun) {
  const Campaign campaign(kTiny);
  EXPECT_NE(run_cleave({"rerun"}).err.find("CELL: the output directory of a run is required"),
            std::string::npos);
  EXPECT_NE(run_cleave({"rerun", campaign / "none"}).err.find("cannot be read"), std::string::npos);
  ASSERT_EQ(run_cleave({"record", "--scene", "rock_pile", "--bodies", "3", "--at", "1", "--out",
                        campaign / "record"})
                .exit_code,
            0);
  EXPECT_NE(run_cleave({"rerun", campaign / "record"}).err.find("command is 'record', allowed: run"),
            std::string::npos);
  EXPECT_NE(run_cleave({"rerun", campaign / "record", "--threads", "0"}).err.find("--threads: 0 is not in"),
            std::string::npos);
}

TEST(VerifyRerun, RepeatsSomeCellsWithTheirThreadsAndWithAnotherNumber) {
  const Campaign campaign(std::string(kTiny) + "seed = [1, 2, 3]\nthreads = [1, 2]\n");
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  const int checks = count_lines(run_cleave({"verify", campaign.out()}).out);
  const ProgramResult some = run_cleave({"verify", campaign.out(), "--rerun", "2"});
  EXPECT_EQ(some.exit_code, 0) << some.out << some.err;
  EXPECT_EQ(count_lines(some.out), checks + 4);
  const ProgramResult all = run_cleave({"verify", campaign.out(), "--rerun", "100"});
  EXPECT_EQ(count_lines(all.out), checks + 12);
  for (const char* how :
       {"repeated run, in ", "repeated run with --threads 1, in ", "repeated run with --threads 2, in "})
    EXPECT_NE(all.out.find(how), std::string::npos) << all.out;
}

// Rows that a program with other results would leave: whole, of one mind, and not to be had again.
TEST(VerifyRerun, FindsRowsThatCannotBeHadAgain) {
  const Campaign campaign(kTiny);
  ASSERT_EQ(campaign.sweep().exit_code, 0);
  const fs::path cell = campaign.cell();
  std::string text = read_text(cell / "steps.csv");
  const std::string hash = read_csv(cell / "steps.csv").at(1, "state_hash");
  for (std::size_t at = text.find(hash); at != std::string::npos; at = text.find(hash, at + 1))
    text.replace(at, hash.size(), "0123456789abcdef");
  std::ofstream(cell / "steps.csv") << text;
  fs::remove(cell / "checksums");
  const ProgramResult result = run_cleave({"verify", cell, "--rerun", "1"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.out.find("state_hash = '0123456789abcdef', again '" + hash + "'"), std::string::npos)
      << result.out;
}

TEST(VerifyRerun, RefusesWhatHoldsNoRun) {
  const Campaign campaign(kTiny);
  const auto refusal = [&campaign](const fs::path& path, const char* count) {
    const ProgramResult result = run_cleave({"verify", path, "--rerun", count});
    EXPECT_EQ(result.exit_code, 1) << result.out;
    EXPECT_EQ(result.out, "");
    return result.err;
  };
  ASSERT_EQ(run_cleave({"record", "--scene", "rock_pile", "--bodies", "3", "--at", "1", "--out",
                        campaign / "record"})
                .exit_code,
            0);
  EXPECT_NE(refusal(campaign / "record", "0").find("--rerun: 0 is not in "), std::string::npos);
  EXPECT_NE(refusal(campaign / "record", "two").find("--rerun: 'two'"), std::string::npos);
  EXPECT_NE(refusal(campaign / "record", "1").find("holds no "), std::string::npos);
  EXPECT_NE(refusal(campaign / "none", "1").find("is no directory"), std::string::npos);
}

}  // namespace
}  // namespace cleave
