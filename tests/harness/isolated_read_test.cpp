// Whatever a reader in a child does, the caller gets its bytes or one line.
#include "harness/files/isolated_read.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <vector>

namespace cleave {
namespace {

constexpr ReadLimits kLimits = {64 << 20, 20};

std::string error_of(const std::function<std::string()>& read, const ReadLimits& limits = kLimits) {
  try {
    read_in_child("a.h5", limits, read);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(IsolatedRead, HandsBackBytesOfAnyLength) {
  const std::string some("a\0b\nc", 5), many(3'000'000, 'x');
  for (const std::string& bytes : {std::string(), some, many})
    EXPECT_TRUE(read_in_child("a.h5", kLimits, [&] { return bytes; }) == bytes);
}

TEST(IsolatedRead, HandsBackTheErrorAsItIs) {
  EXPECT_EQ(error_of([]() -> std::string { throw std::runtime_error("a.h5: rhs is missing"); }),
            "a.h5: rhs is missing");
}

TEST(IsolatedRead, CrashIsALine) {
  const std::string text = "a.h5: damaged: the HDF5 library crashed while reading it";
  for (const auto& [signal, name] : {std::pair{SIGSEGV, "SEGV"}, {SIGABRT, "ABRT"}, {SIGFPE, "FPE"}})
    EXPECT_EQ(error_of([signal = signal]() -> std::string {
                ::raise(signal);
                return "";
              }),
              text + " (SIG" + name + ")");
  EXPECT_EQ(error_of([]() -> std::string { ::_exit(3); }), text);
}

TEST(IsolatedRead, EndlessLoopIsALine) {
  const auto loop = []() -> std::string {
    volatile unsigned turns = 0;
    for (;;) turns = turns + 1;
  };
  EXPECT_EQ(error_of(loop, {64 << 20, 1}),
            "a.h5: damaged: the HDF5 library had not read it after 1 s of processor time");
}

TEST(IsolatedRead, MemoryIsLimited) {
  EXPECT_EQ(error_of([]() -> std::string {
              // Volatile, or the compiler takes memory that is never used for granted.
              void* const volatile memory = std::malloc(std::size_t{1} << 40);
              return memory == nullptr ? throw std::runtime_error("no room") : "";
            }),
            "no room");
}

TEST(IsolatedRead, OpensNothingOnceForbidden) {
  const std::string opened = read_in_child("a.h5", kLimits, [] {
    forbid_opening_files();
    return std::to_string(::open("/dev/zero", O_RDONLY));
  });
  EXPECT_EQ(opened, "-1");
}

TEST(IsolatedRead, LeavesTheProcessAsItWas) {
  EXPECT_NE(error_of([]() -> std::string { ::abort(); }), "");
  const int file = ::open("/dev/zero", O_RDONLY);
  EXPECT_GE(file, 0);
  ::close(file);
}

}  // namespace
}  // namespace cleave
