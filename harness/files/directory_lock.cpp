#include "harness/files/directory_lock.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "harness/base/printable_text.h"
#include "harness/files/build_info.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

// What a lock file says; empty where it says nothing.
struct Owner {
  std::string host, pid, start, command;
};

struct flock whole_file_lock() {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

std::string read_all(int file) {
  std::array<char, 1024> text;
  const ssize_t size = ::pread(file, text.data(), text.size(), 0);
  return {text.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
}

Owner read_owner(int file) {
  Owner owner;
  std::istringstream lines(read_all(file));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    const std::string name = line.substr(0, colon), value = line.substr(colon + 2);
    if (name == "host") owner.host = value;
    if (name == "pid") owner.pid = value;
    if (name == "start") owner.start = value;
    if (name == "command") owner.command = value;
  }
  return owner;
}

// Who has only just locked the file writes a moment later who it is.
Owner wait_for_owner(int file) {
  constexpr int kMostWaits = 1000;
  Owner owner = read_owner(file);
  for (int k = 0; k < kMostWaits && owner.pid.empty(); ++k, owner = read_owner(file))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return owner;
}

std::string who(const Owner& owner) {
  if (owner.pid.empty()) return "another process";
  return "process " + owner.pid + " on host " + owner.host + " (" + owner.command + ", started " +
         owner.start + ")";
}

[[noreturn]] void refuse_held(const fs::path& path, const Owner& owner) {
  throw std::invalid_argument("--out: '" + path.parent_path().string() + "' is being written by " +
                              who(owner) + "; wait for its end or name another directory");
}

[[noreturn]] void fail(const fs::path& path, const char* what) {
  throw std::runtime_error(path.string() + ": " + what + ": " + std::strerror(errno));
}

}  // namespace

DirectoryLock::DirectoryLock(const fs::path& directory, const std::string& command,
                             LeftElsewhere left_elsewhere)
    : path_(directory / kLockFile) {
  try {
    while (!open_and_lock()) continue;
    take_over_or_refuse(left_elsewhere);
    write_owner(command);
  } catch (...) {
    if (file_ >= 0) ::close(file_);
    throw;
  }
}

DirectoryLock::~DirectoryLock() {
  ::unlink(path_.c_str());  // first: a file of this name that nobody holds is that of a killed process
  ::close(file_);
}

bool DirectoryLock::open_and_lock() {
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) fail(path_, "cannot be written");
  struct flock lock = whole_file_lock();
  if (::fcntl(file_, F_OFD_SETLK, &lock) != 0) {
    if (errno == EAGAIN || errno == EACCES) refuse_held(path_, wait_for_owner(file_));
    fail(path_, "cannot be locked; name a directory on a disk that has locks");
  }
  struct stat locked, named;
  if (::fstat(file_, &locked) == 0 && ::stat(path_.c_str(), &named) == 0 && locked.st_ino == named.st_ino &&
      locked.st_dev == named.st_dev)
    return true;
  ::close(file_);  // whoever held it has just deleted it
  file_ = -1;
  return false;
}

void DirectoryLock::take_over_or_refuse(LeftElsewhere left_elsewhere) const {
  const Owner owner = read_owner(file_);
  if (owner.pid.empty()) return;
  if (owner.host != host_name() && left_elsewhere == LeftElsewhere::refuse)
    throw std::invalid_argument(
        "--out: " + path_.string() + " was left by " + who(owner) +
        ", which cannot be checked from here; delete the file if that process has ended");
  say(path_.string() + ": left by " + who(owner) + ", which has ended without its last word; taken over");
}

void DirectoryLock::write_owner(const std::string& command) const {
  const std::string text = "host: " + host_name() + "\npid: " + std::to_string(::getpid()) +
                           "\nstart: " + utc_now() + "\ncommand: " + command + "\n";
  if (::ftruncate(file_, 0) == 0 &&
      ::pwrite(file_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()))
    return;
  const int reason = errno;
  ::unlink(path_.c_str());
  errno = reason;
  fail(path_, "cannot be written");
}

void check_not_locked(const fs::path& directory) {
  const fs::path path = directory / kLockFile;
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  struct flock lock = whole_file_lock();
  const bool held = ::fcntl(file, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
  const Owner owner = read_owner(file);
  ::close(file);
  if (held) refuse_held(path, owner);
}

}  // namespace cleave
