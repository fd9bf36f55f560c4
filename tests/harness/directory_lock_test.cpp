// One writer a directory, with real processes; what a killed one leaves; and what --force takes away.
#include "harness/files/directory_lock.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <set>
#include <stdexcept>
#include <thread>

#include "harness/files/build_info.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> long_run(const fs::path& out) {
  return {"run",       "--scene", "rock_pile", "--bodies",   "200",     "--partitioner", "mindp",
          "--refiner", "none",    "--out",     out.string(), "--steps", "100000",        "--force"};
}

std::vector<std::string> short_run(const fs::path& out) {
  return {"run",           "--scene", "ladder_heavy_top", "--out", out.string(), "--steps", "2",
          "--partitioner", "mindp",   "--refiner",        "none"};
}

std::set<std::string> names_in(const fs::path& directory) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory))
    names.insert(entry.path().filename());
  return names;
}

// A run that has begun to write, ended whatever happens.
class Running {
 public:
  explicit Running(const fs::path& out) : process_(start_cleave(long_run(out))) {
    while (count_lines(read_text(out / "steps.csv")) < 2) ::usleep(1000);
  }
  ~Running() {
    if (process_ > 0) end(SIGKILL);
  }
  pid_t process() const { return process_; }
  int end(int signal) {
    ::kill(process_, signal);
    const int code = finish_cleave(process_);
    process_ = 0;
    return code;
  }

 private:
  pid_t process_;
};

TEST(DirectoryLock, WaitsForTheNameOfWhoHasOnlyJustLocked) {
  const TemporaryDirectory directory;
  const fs::path out = directory / "out", path = out / kLockFile;
  fs::create_directory(out);
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  struct flock lock {};
  lock.l_type = F_WRLCK;
  ASSERT_EQ(::fcntl(file, F_OFD_SETLK, &lock), 0);
  std::thread holder([file] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const std::string text = "host: here\npid: 4711\nstart: now\ncommand: cleave run\n";
    EXPECT_EQ(::pwrite(file, text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
  });
  try {
    const DirectoryLock second(out, "cleave run");
    ADD_FAILURE() << "two hold it";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("process 4711 on host here"), std::string::npos) << error.what();
  }
  holder.join();
  ::close(file);
}

TEST(DirectoryLock, TheSecondIsToldWhoWritesAndTouchesNothing) {
  const TemporaryDirectory directory;
  const fs::path out = directory / "out";
  Running first(out);
  const std::string manifest = read_text(out / "manifest.json");
  const std::set<std::string> names = names_in(out);
  for (const bool force : {false, true}) {
    std::vector<std::string> arguments = short_run(out);
    if (force) arguments.push_back("--force");
    const ProgramResult second = run_cleave(arguments);
    EXPECT_EQ(second.exit_code, 1);
    EXPECT_EQ(second.out, "");
    EXPECT_EQ(count_lines(second.err), 1) << second.err;
    const std::string who = "is being written by process " + std::to_string(first.process()) + " on host " +
                            host_name() + " (cleave run, started 2";
    EXPECT_NE(second.err.find(who), std::string::npos) << second.err;
  }
  EXPECT_EQ(read_text(out / "manifest.json"), manifest);
  EXPECT_EQ(names_in(out), names);
  const ProgramResult verified = run_cleave({"verify", out});
  EXPECT_EQ(verified.exit_code, 3);
  EXPECT_NE(verified.out.find("state running; incomplete: it is still running"), std::string::npos)
      << verified.out;

  EXPECT_EQ(first.end(SIGINT), 130);
  EXPECT_FALSE(fs::exists(out / kLockFile));
}

// Started at the same moment, again and again: one writes, the others are told, and the table is that of one.
TEST(DirectoryLock, OfManyAtOnceOneWrites) {
  for (int turn = 0; turn < 10; ++turn) {
    const TemporaryDirectory directory;
    const fs::path out = directory / "new/out";
    std::vector<pid_t> processes;
    for (int i = 0; i < 4; ++i) processes.push_back(start_cleave(short_run(out)));
    int succeeded = 0;
    for (const pid_t process : processes) {
      const int code = finish_cleave(process);
      EXPECT_TRUE(code == 0 || code == 1) << code;
      succeeded += code == 0;
    }
    EXPECT_EQ(succeeded, 1);
    EXPECT_EQ(run_cleave({"verify", out}).exit_code, 0);
    EXPECT_EQ(names_in(out), (std::set<std::string>{"checksums", "manifest.json", "steps.csv"}));
  }
}

TEST(DirectoryLock, WhatAKilledProcessLeftIsTakenOver) {
  const TemporaryDirectory directory;
  const fs::path out = directory / "out";
  Running first(out);
  const std::string pid = std::to_string(first.process());
  EXPECT_EQ(first.end(SIGKILL), 128 + SIGKILL);
  EXPECT_TRUE(fs::exists(out / kLockFile));
  const ProgramResult verified = run_cleave({"verify", out});
  EXPECT_EQ(verified.exit_code, 3);
  EXPECT_NE(verified.out.find("state running; incomplete: it was killed"), std::string::npos) << verified.out;

  std::vector<std::string> again = short_run(out);
  again.push_back("--force");
  const ProgramResult second = run_cleave(again);
  EXPECT_EQ(second.exit_code, 0) << second.err;
  EXPECT_NE(second.err.find("cleave.lock: left by process " + pid), std::string::npos) << second.err;
  EXPECT_NE(second.err.find("taken over"), std::string::npos) << second.err;
  EXPECT_EQ(run_cleave({"verify", out}).exit_code, 0);
  EXPECT_FALSE(fs::exists(out / kLockFile));
}

TEST(DirectoryLock, WhatAnotherHostLeftIsNamedAndKept) {
  const TemporaryDirectory directory;
  const std::string text = "host: elsewhere\npid: 12\nstart: 2024-01-31T12:00:00Z\ncommand: cleave replay\n";
  std::ofstream(directory / kLockFile) << text;
  const ProgramResult result = run_cleave(short_run(directory.path()));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err,
            "cleave run: --out: " + (directory / kLockFile).string() +
                " was left by process 12 on host elsewhere (cleave replay, started "
                "2024-01-31T12:00:00Z), which cannot be checked from here; delete the file if that "
                "process has ended\n");
  EXPECT_EQ(names_in(directory.path()), (std::set<std::string>{kLockFile}));
  EXPECT_EQ(read_text(directory / kLockFile), text);
}

TEST(DirectoryLock, WhatAnotherHostLeftIsTakenOverWhereThatIsAskedForAndWhatIsHeldIsNot) {
  const TemporaryDirectory directory;
  std::ofstream(directory / kLockFile) << "host: elsewhere\npid: 12\nstart: now\ncommand: cleave run\n";
  {
    const DirectoryLock lock(directory.path(), "cleave test", LeftElsewhere::take_over);
    EXPECT_NE(read_text(directory / kLockFile).find("host: " + host_name() + "\n"), std::string::npos);
    std::ofstream(directory / kLockFile) << "host: elsewhere\npid: 12\nstart: now\ncommand: cleave run\n";
    EXPECT_THROW(DirectoryLock(directory.path(), "cleave test", LeftElsewhere::take_over),
                 std::invalid_argument);
  }
  EXPECT_FALSE(fs::exists(directory / kLockFile));
}

TEST(DirectoryLock, IsGivenUpOnErrorsToo) {
  const TemporaryDirectory directory;
  {
    const DirectoryLock lock(directory.path(), "cleave test");
    EXPECT_THROW(DirectoryLock(directory.path(), "cleave test"), std::invalid_argument);
    EXPECT_THROW(check_not_locked(directory.path()), std::invalid_argument);
    EXPECT_TRUE(fs::exists(directory / kLockFile));
  }
  EXPECT_NO_THROW(check_not_locked(directory.path()));
  EXPECT_FALSE(fs::exists(directory / kLockFile));
}

std::vector<std::string> record(const fs::path& out, const std::string& at) {
  return {"record", "--scene", "rock_pile", "--bodies", "20", "--at", at, "--out", out.string()};
}

TEST(Force, TakesAwayAllOfTheEarlierRun) {
  const TemporaryDirectory directory;
  const fs::path out = directory / "out";
  ASSERT_EQ(run_cleave(record(out, "5,6")).exit_code, 0);
  std::ofstream(out / "notes.txt") << "of someone else";
  std::vector<std::string> again = record(out, "7");
  again.push_back("--force");
  ASSERT_EQ(run_cleave(again).exit_code, 0);
  EXPECT_EQ(names_in(out), (std::set<std::string>{"checksums", "manifest.json", "notes.txt",
                                                  "rock_pile_step000007.h5", "steps.csv"}));
  const ProgramResult verified = run_cleave({"verify", out});
  EXPECT_EQ(verified.exit_code, 3);
  EXPECT_NE(verified.out.find("notes.txt is not of this run"), std::string::npos) << verified.out;
  fs::remove(out / "notes.txt");
  EXPECT_EQ(run_cleave({"verify", out}).exit_code, 0);
}

TEST(Force, DoesNotTakeAwayWhatIsReplayed) {
  const TemporaryDirectory directory;
  const fs::path out = directory / "out";
  ASSERT_EQ(run_cleave(record(out, "5")).exit_code, 0);
  const std::string file = out / "rock_pile_step000005.h5";
  const ProgramResult replayed = run_cleave({"replay", file, "--out", out, "--force"});
  EXPECT_EQ(replayed.exit_code, 1);
  EXPECT_NE(replayed.err.find("--out: '" + out.string() + "' holds " + file), std::string::npos)
      << replayed.err;
  EXPECT_EQ(run_cleave({"verify", out}).exit_code, 0);
}

}  // namespace
}  // namespace cleave
