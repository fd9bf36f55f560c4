// The program among others: its standard files closed, full or gone, a disk or a memory that ends, signals.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "harness/base/standard_streams.h"
#include "harness/files/manifest.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
// In bash, with $cleave the program and $d a fresh directory.
struct Shell {
  TemporaryDirectory directory;
  ProgramResult run(const std::string& script) const {
    return run_program("/bin/bash", {"-c", "cleave='" + std::string(CLEAVE_PROGRAM) + "'; d='" +
                                               directory.path().string() + "'; " + script});
  }
};

constexpr const char* kTinyRun =
    "$cleave run --scene rock_pile --bodies 3 --steps 2 --measure-every 1 --partitioner mindp "
    "--refiner none --solver schur --out $d/out ";

// Which number the next file gets in a process that was started with some of 0, 1 and 2 closed.
int next_descriptor(const std::vector<int>& closed) {
  const pid_t process = ::fork();
  if (process == 0) {
    for (const int descriptor : closed) ::close(descriptor);
    open_standard_streams();
    ::_exit(::open("/dev/null", O_RDONLY));
  }
  int status = 0;
  ::waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(StandardStreams, NoFileGetsTheNumberOfOne) {
  for (const std::vector<int>& closed : {std::vector<int>{0}, {1}, {2}, {0, 1}, {1, 2}, {0, 2}, {0, 1, 2}})
    EXPECT_GT(next_descriptor(closed), STDERR_FILENO);
}

TEST(StandardStreams, MayBeClosed) {
  for (const char* closed : {"2>&-", ">&-", "<&-", "<&- >&- 2>&-"}) {
    const Shell shell;
    const ProgramResult result = shell.run(std::string(kTinyRun) + closed);
    EXPECT_EQ(result.exit_code, 0) << closed << result.err;
    const CsvTable table = read_csv(shell.directory / "out/steps.csv");
    ASSERT_EQ(table.rows.size(), 2u) << closed;
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
  }
}

TEST(StandardStreams, AFullOutputIsOneLineAndExitCodeOne) {
  const Shell shell;
  ASSERT_EQ(shell.run("$cleave record --scene rock_pile --bodies 3 --at 1 --out $d/out").exit_code, 0);
  for (const char* command : {"list", "list columns", "--help", "run --help", "--version",
                              "verify $d/out/*.h5", "run --scene rock_pile --out $d/none --print-key"}) {
    const ProgramResult result = shell.run(std::string("$cleave ") + command + " > /dev/full");
    EXPECT_EQ(result.exit_code, 1) << command;
    const std::string last = result.err.substr(result.err.rfind("cleave"));
    EXPECT_NE(last.find("standard output: cannot be written: No space left on device\n"), std::string::npos)
        << command << ": " << result.err;
    EXPECT_EQ(count_lines(last), 1) << result.err;
  }
}

TEST(StandardStreams, AReaderThatIsGoneIsAQuietEnd) {
  const Shell shell;
  const std::string gone = "exec {pipe}> >(exec true); wait $!; ";
  const ProgramResult list = shell.run(gone + "$cleave list >&$pipe");
  EXPECT_EQ(list.exit_code, 141);
  EXPECT_EQ(list.err, "");
  // Nobody reads what it says, but its files do not depend on that.
  const ProgramResult run = shell.run(gone + kTinyRun + "2>&$pipe");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(read_csv(shell.directory / "out/steps.csv").rows.size(), 2u);
}

TEST(FullDisk, IsOneLineAndEndsTheManifest) {
  const Shell shell;
  const ProgramResult result = shell.run(
      "ulimit -f 100; exec $cleave run --scene rock_pile --bodies 3 --steps 200 --measure-every 1 "
      "--partitioner mindp --refiner none,fm --solver schur,exact --out $d/out");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "cleave run: " + (shell.directory / "out/steps.csv").string() +
                            ": cannot be written: File too large\n");
  const std::string text = read_text(shell.directory / "out/steps.csv");
  EXPECT_GT(count_lines(text), 4);
  EXPECT_TRUE(text.ends_with("\n"));
  const CsvTable table = parse_csv(text);
  EXPECT_EQ(table.rows.size() % 3, 0u);
  for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
  EXPECT_NE(read_text(shell.directory / "out/manifest.json").find("\"state\": \"failed\""),
            std::string::npos);
}

TEST(FullDisk, ADeviceThatIsFullIsNamed) {
  const Shell shell;
  fs::create_directory(shell.directory / "out");
  fs::create_symlink("/dev/full", shell.directory / "out/steps.csv");
  const ProgramResult result = shell.run(std::string(kTinyRun) + "--force");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(count_lines(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("out/steps.csv: cannot be written: No space left on device"), std::string::npos)
      << result.err;
}

// What stands in the way of a second manifest: its name aside is taken by a directory.
TEST(FullDisk, AManifestThatCannotBeWrittenAgainDoesNotSayRunning) {
  const TemporaryDirectory directory;
  const fs::path path = directory / "manifest.json";
  WorkDescription description;
  description.command = "run";
  description.run_id = "id";
  const auto take_name = [&] { fs::create_directory(path.string() + ".part"); };
  const auto work_fails = [&]() -> WorkResult {
    take_name();
    throw std::runtime_error("the first error");
  };
  try {
    Manifest(path, description).around(work_fails);
    FAIL() << "the error went nowhere";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "the first error");
  }
  EXPECT_NE(read_text(path).find("\"state\": \"failed\" ,"), std::string::npos) << read_text(path);
  fs::remove(path.string() + ".part");

  const auto work_ends = [&] {
    take_name();
    return WorkResult{};
  };
  EXPECT_THROW(Manifest(path, description).around(work_ends), std::runtime_error);
  const ProgramResult parsed = run_program(
      "/usr/bin/python3", {"-c", "import json, sys; print(json.load(open(sys.argv[1]))['state'])", path});
  EXPECT_EQ(parsed.out, "failed\n");
}

TEST(LittleMemory, IsARowOrALine) {
  int short_of_memory = 0;
  for (const char* kbytes : {"40000", "50000", "60000", "70000", "80000", "150000"}) {
    for (const char* threads : {"1", "2"}) {
      const Shell shell;
      SCOPED_TRACE(std::string(kbytes) + " kB, threads " + threads);
      const ProgramResult list = shell.run(std::string("ulimit -v ") + kbytes + "; exec $cleave list");
      EXPECT_EQ(list.exit_code, list.err.empty() ? 0 : 1) << list.err;
      const ProgramResult result =
          shell.run(std::string("ulimit -v ") + kbytes +
                    "; exec $cleave run --scene rock_pile --bodies 120 --steps 60 --measure-every 30 "
                    "--partitioner mindp --refiner none --solver dense,schur,exact --out $d/out --threads " +
                    threads);
      EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1 || result.exit_code == 2)
          << result.exit_code << ": " << result.err;
      if (result.exit_code == 1) {
        EXPECT_EQ(count_lines(result.err), 1) << result.err;
      } else {
        EXPECT_EQ(read_csv(shell.directory / "out/steps.csv").rows.size(), 6u);
      }
      short_of_memory += result.exit_code == 1 || result.err.find("out_of_memory") != std::string::npos;
    }
  }
  EXPECT_GE(short_of_memory, 3);
}

// From where the loader just finds room for the libraries: memory ends before main, in destructors, for
// exceptions.
TEST(LittleMemory, IsALineWhereverItEnds) {
  int lines = 0;
  for (int kbytes = 28000; kbytes <= 36000; kbytes += 100) {
    const Shell shell;
    const ProgramResult list = shell.run("ulimit -v " + std::to_string(kbytes) + "; exec $cleave list");
    SCOPED_TRACE(std::to_string(kbytes) + " kB: " + list.err);
    if (list.exit_code == 127) continue;  // the loader's own words
    EXPECT_TRUE(list.exit_code == 0 || list.exit_code == 1) << list.exit_code;
    // In words of the program's own, or of a library that begins before it.
    EXPECT_EQ(list.err.find("ut of memory") != std::string::npos, list.exit_code == 1);
    lines += list.exit_code;
  }
  EXPECT_GT(lines, 0);
}

TEST(LittleMemory, CallsNoFileDamaged) {
  const Shell shell;
  ASSERT_EQ(shell.run("$cleave record --scene rock_pile --bodies 12 --at 60 --out $d/in").exit_code, 0);
  int lines = 0;
  for (int kbytes = 30000; kbytes <= 38000; kbytes += 100) {
    const ProgramResult verified =
        shell.run("ulimit -v " + std::to_string(kbytes) + "; exec $cleave verify $d/in");
    EXPECT_EQ(verified.err.find("damaged"), std::string::npos) << kbytes << " kB: " << verified.err;
    lines += verified.err.find("kB of memory allowed") != std::string::npos;
  }
  EXPECT_GT(lines, 0);
}

// HDF5 crashes where it finds no memory for a file's cache: a window of some hundred kB.
TEST(LittleMemory, EndsNoWriterInACrash) {
  const Shell shell;
  ASSERT_EQ(shell.run("$cleave record --scene rock_pile --bodies 30 --at 10,40 --out $d/in").exit_code, 0);
  int lines = 0;
  for (int kbytes = 36000; kbytes <= 54000; kbytes += 150) {
    const ProgramResult replayed =
        shell.run("ulimit -v " + std::to_string(kbytes) +
                  "; exec $cleave replay $d/in/*.h5 --solver schur,pgs --threads 2 --write-solutions "
                  "--out $d/out --force");
    EXPECT_TRUE(replayed.exit_code >= 0 && replayed.exit_code <= 2)
        << kbytes << " kB: " << replayed.exit_code;
    lines += replayed.exit_code == 1;
  }
  EXPECT_GT(lines, 0);
}

// A command that has begun to write rows.
struct Running {
  Running(const fs::path& out, const Arguments& arguments, int lines) : csv(out / "steps.csv") {
    Arguments all = arguments;
    all.insert(all.end(), {"--out", out, "--threads", "1"});
    process = start_cleave(all);
    while (count_lines(read_text(csv)) < lines && ::waitpid(process, nullptr, WNOHANG) == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  fs::path csv;
  pid_t process;
};

// So many repeats that no measured step comes to its end: whoever goes on with it after the signal never
// ends.
const Arguments kEndlessStep = {
    "--repeats", "1000000", "--partitioner", "mindp,mix",
    "--refiner", "none,fm", "--solver",      "schur,exact,pgs,pivot:schur-bodies"};

void expect_nothing_after_signal(const Arguments& command, int trials) {
  const unsigned seed = 11;
  std::mt19937 random(seed);
  for (int trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(trial);
    const TemporaryDirectory directory;
    const fs::path out = directory / "out";
    Arguments arguments = command;
    arguments.insert(arguments.end(), kEndlessStep.begin(), kEndlessStep.end());
    const Running running(out, arguments, 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 300));
    ::kill(running.process, trial % 2 == 0 ? SIGINT : SIGTERM);
    EXPECT_EQ(finish_cleave(running.process), 130);
    EXPECT_EQ(count_lines(read_text(running.csv)), 1);
    EXPECT_NE(read_text(out / "manifest.json").find("\"state\": \"interrupted\""), std::string::npos);
  }
}

TEST(Signals, NoSolveOfARunBeginsAfterOne) {
  expect_nothing_after_signal({"run", "--scene", "large_rock_pile", "--measure-every", "1", "--steps", "2"},
                              4);
}

TEST(Signals, NoSolveOfAReplayBeginsAfterOne) {
  const TemporaryDirectory directory;
  const ProgramResult recorded = run_cleave(
      {"record", "--scene", "rock_pile", "--bodies", "60", "--at", "50", "--out", directory / "in"});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  expect_nothing_after_signal({"replay", directory / "in/rock_pile_step000050.h5"}, 2);
}

// A partitioner that would try a hundred million times ends after the trial at hand.
TEST(Signals, NoTrialOfAPartitionerBeginsAfterOne) {
  const TemporaryDirectory directory;
  const Running running(
      directory / "out",
      {"run", "--scene", "rock_pile", "--bodies", "30", "--steps", "2", "--measure-every", "2",
       "--partitioner", "karger@trials=100000000", "--refiner", "none", "--solver", "schur"},
      1);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  ::kill(running.process, SIGINT);
  EXPECT_EQ(finish_cleave(running.process), 130);
  EXPECT_EQ(count_lines(read_text(running.csv)), 1);
}

// What a run was to explain it does not when it is interrupted, and its files are those that it has.
TEST(Signals, AnInterruptedRunExplainsNothing) {
  const TemporaryDirectory directory;
  const Running running(
      directory / "out",
      {"run", "--scene", "rock_pile", "--bodies", "12", "--steps", "1000000", "--explain-model"}, 10);
  ::kill(running.process, SIGINT);
  EXPECT_EQ(finish_cleave(running.process), 130);
  EXPECT_FALSE(fs::exists(directory / "out/explain_model.csv"));
  EXPECT_TRUE(fs::exists(directory / "out/checksums"));
}

// record writes a step's file and row or neither.
TEST(Signals, ARecordingEndsBetweenSteps) {
  const TemporaryDirectory directory;
  std::string at = "0";
  for (int step = 1; step < 3000; ++step) at.append(",").append(std::to_string(step));
  const Running running(directory / "out", {"record", "--scene", "rock_pile", "--bodies", "30", "--at", at},
                        4);
  ::kill(running.process, SIGINT);
  EXPECT_EQ(finish_cleave(running.process), 130);
  const CsvTable table = read_csv(running.csv);
  EXPECT_LT(table.rows.size(), 3000u);
  for (const std::string& name : table.column("problem_file"))
    EXPECT_TRUE(fs::exists(directory / "out" / name));
}

// A terminal that is closed sends two; nohup has them ignored.
TEST(Signals, ASecondHangUpChangesNothing) {
  const TemporaryDirectory directory;
  const Running running(directory / "out",
                        {"run", "--scene", "rock_pile", "--bodies", "12", "--steps", "1000000"}, 10);
  ::kill(running.process, SIGHUP);
  for (int k = 0; k < 20; ++k) ::kill(running.process, SIGHUP);
  EXPECT_EQ(finish_cleave(running.process), 130);
}

TEST(Signals, AHangUpIsNotHeardUnderNohup) {
  const TemporaryDirectory directory;
  ::signal(SIGHUP, SIG_IGN);
  const Running running(directory / "out",
                        {"run", "--scene", "rock_pile", "--bodies", "12", "--steps", "1000000"}, 10);
  ::signal(SIGHUP, SIG_DFL);
  ::kill(running.process, SIGHUP);
  const int lines = count_lines(read_text(running.csv));
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (count_lines(read_text(running.csv)) < lines + 100 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_GE(count_lines(read_text(running.csv)), lines + 100);
  ::kill(running.process, SIGTERM);
  EXPECT_EQ(finish_cleave(running.process), 130);
}

// Both are on their way before the program sees one.
TEST(Signals, ASecondOneEndsAtOnce) {
  const TemporaryDirectory directory;
  const Running running(directory / "out",
                        {"run", "--scene", "rock_pile", "--bodies", "12", "--steps", "1000000"}, 10);
  ::kill(running.process, SIGSTOP);
  ::kill(running.process, SIGINT);
  ::kill(running.process, SIGTERM);
  ::kill(running.process, SIGCONT);
  EXPECT_EQ(finish_cleave(running.process), 128 + SIGTERM);
  EXPECT_TRUE(read_text(running.csv).ends_with("\n"));
}

}  // namespace
}  // namespace cleave
