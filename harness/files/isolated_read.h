// Reading what may be damaged in a child process.
//
// The HDF5 library trusts a file: damaged lengths and pointers in it end in a crash, an endless loop or a
// request for all memory. The child alone meets that; it hands back plain bytes, which the caller checks.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace cleave {

struct ReadLimits {
  std::size_t memory_bytes;  // beyond what the process has at the start
  int processor_s;
};

// Far more than a sound file of this size takes.
ReadLimits read_limits(const std::filesystem::path& path);

// Runs `read` in a child and returns what it returns. A std::exception of `read` becomes a
// std::invalid_argument of the same text; so does the child's end by a signal or by a limit: "SUBJECT:
// damaged: the HDF5 library crashed while reading it (SIGSEGV)". Anything that the child prints is lost.
// `read` must not use threads.
std::string read_in_child(const std::string& subject, const ReadLimits& limits,
                          const std::function<std::string()>& read);

// In the child, once the file is open: no other is opened any more, so that nothing in it can name one to
// wait for.
void forbid_opening_files();

}  // namespace cleave
