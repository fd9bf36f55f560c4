// One writer a directory: whoever writes into an output directory holds the lock on the file cleave.lock in
// it.
//
// The lock is that of the system on the open file (F_OFD_SETLK), which ends with the process however that
// ends, is seen by every process of the host and, on network disks that have locks, of other hosts. So a
// process that was killed leaves a file that nobody holds, and no process number has to be looked up that may
// be another's by now. What the file says (host, pid, start, command) is for the line that tells who holds
// it, and for disks whose locks do not reach other hosts: a file of another host that nobody seems to hold
// cannot be checked from here.
#pragma once

#include <filesystem>
#include <string>

namespace cleave {

inline constexpr const char* kLockFile = "cleave.lock";

// What is done about a file that another host left and that nobody seems to hold.
enum class LeftElsewhere {
  refuse,
  take_over,  // where something else knows that its process has ended, as a batch system does of its tasks
};

class DirectoryLock {
 public:
  // Takes the lock at once or throws std::invalid_argument with one line: who holds it, or which file to
  // delete where another host left it; std::runtime_error where the disk has no locks. What a killed process
  // of this host left is taken over with a line on stderr. command: what the file says of us, "cleave run".
  DirectoryLock(const std::filesystem::path& directory, const std::string& command,
                LeftElsewhere left_elsewhere = LeftElsewhere::refuse);
  // Deletes the file and gives the lock up.
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  // Whether the file that was locked is still the one of that name.
  bool open_and_lock();
  void take_over_or_refuse(LeftElsewhere left_elsewhere) const;
  void write_owner(const std::string& command) const;

  std::filesystem::path path_;
  int file_ = -1;
};

// Throws as the lock does where a running process holds it; touches nothing.
void check_not_locked(const std::filesystem::path& directory);

}  // namespace cleave
