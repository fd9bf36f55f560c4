// A cell as a process of its own: whatever happens in it, the campaign goes on.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace cleave {

struct CellCommand {
  std::vector<std::string> words;  // of this same program, its name first
  double memory_gb;                // most address space, 1e9 bytes; NaN: no limit of the campaign's
  std::vector<int> cores;          // that it may use; empty: all
};

// How a process ended.
struct CellEnd {
  int exit_code = -1;  // -1: a signal ended it
  int signal = 0;
  std::string printed;  // the last of what it printed

  // "ended by SIGABRT", "ended with exit code 1".
  std::string text() const;
  // Of what it printed; empty where it printed nothing.
  std::string last_line() const;
};

// The process gets no terminal and a process group of its own, so that an interrupt on the keyboard reaches
// it once, through us; it is killed when we die, however that happens. What it prints is kept in memory.
class CellProcess {
 public:
  // Throws std::runtime_error where no process can be made.
  explicit CellProcess(const CellCommand& command);
  ~CellProcess();  // kills it where it still runs
  CellProcess(const CellProcess&) = delete;
  CellProcess& operator=(const CellProcess&) = delete;

  // Looks without waiting; true once it has ended.
  bool has_ended();
  // Of a process that has ended.
  CellEnd end() const;
  void send(int signal) const;
  double seconds() const;       // since its start, until its end
  std::string printed() const;  // the last of what it has printed so far

 private:
  using Clock = std::chrono::steady_clock;
  pid_t pid_ = -1;
  int printed_ = -1;  // a file in memory
  int status_ = 0;
  Clock::time_point start_ = Clock::now(), end_ = start_;
  bool ended_ = false;
};

// Makes the process and waits for its end; signals to stop, which are waited for too, are passed on to it as
// SIGTERM. True into `interrupted` where one came.
CellEnd run_to_end(const CellCommand& command, bool& interrupted);

// While it stands, these signals wait until they are asked for: SIGCHLD and those to stop. Processes of cells
// get them as ever.
class SignalsWaitedFor {
 public:
  SignalsWaitedFor();
  ~SignalsWaitedFor();
  // The next of them, or 0 after so many seconds.
  int wait(double seconds) const;
};

}  // namespace cleave
