// What becomes of a solve whose library answers, hangs, crashes or finds no memory: made-up libraries.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <thread>

#include "harness/peers/peer_process.h"

namespace cleave {
namespace {

constexpr double kLong_s = 300;

[[noreturn]] void hang() {
  for (;;) ::pause();
}

TEST(PeerProcess, AnAnswerComesBackWhole) {
  PeerAnswer sent{.claims_success = true,
                  .message = "said, with a , in it",
                  .iterations = 7,
                  .solve_ms = 1.5,
                  .impulse = {}};
  for (int r = 0; r < 100000; ++r) sent.impulse.push_back(1.0 / (r + 3));
  const PeerEnd end = run_peer([&] { return sent; }, kLong_s, nullptr);
  EXPECT_EQ(end.status, SolveStatus::ok) << end.message;
  EXPECT_TRUE(end.answer.claims_success);
  EXPECT_EQ(end.answer.message, sent.message);
  EXPECT_EQ(end.answer.iterations, 7);
  EXPECT_EQ(end.answer.solve_ms, 1.5);
  EXPECT_EQ(end.answer.impulse, sent.impulse);
}

TEST(PeerProcess, WhatTakesTooLongIsEnded) {
  const PeerEnd end = run_peer([]() -> PeerAnswer { hang(); }, 0.05, nullptr);
  EXPECT_EQ(end.status, SolveStatus::timeout);
  EXPECT_EQ(end.message, "ended after 0.05 s");
}

TEST(PeerProcess, ACrashIsTheChildsAlone) {
  const PeerEnd end = run_peer([]() -> PeerAnswer { std::abort(); }, kLong_s, nullptr);
  EXPECT_EQ(end.status, SolveStatus::crashed);
  EXPECT_NE(end.message.find("SIGABRT"), std::string::npos) << end.message;
  const PeerEnd left = run_peer([]() -> PeerAnswer { ::_exit(3); }, kLong_s, nullptr);
  EXPECT_EQ(left.status, SolveStatus::crashed);
  EXPECT_NE(left.message.find("code 3"), std::string::npos) << left.message;
}

TEST(PeerProcess, ExceptionsAreToldApart) {
  const PeerEnd wrong =
      run_peer([]() -> PeerAnswer { throw std::logic_error("no option x"); }, kLong_s, nullptr);
  EXPECT_EQ(wrong.status, SolveStatus::crashed);
  EXPECT_EQ(wrong.message, "no option x");
  const PeerEnd full = run_peer([]() -> PeerAnswer { throw std::bad_alloc(); }, kLong_s, nullptr);
  EXPECT_EQ(full.status, SolveStatus::out_of_memory);
}

TEST(PeerProcess, WhatALibraryPrintsIsLost) {
  testing::internal::CaptureStdout();
  run_peer(
      [] {
        std::printf("Error (x[1] = 3)\n");
        std::fflush(stdout);
        return PeerAnswer{};
      },
      kLong_s, nullptr);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(PeerProcess, ARunThatIsStoppedDoesNotWait) {
  std::atomic<bool> stop = false;
  std::thread asker([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    stop = true;
  });
  EXPECT_THROW(run_peer([]() -> PeerAnswer { hang(); }, kLong_s, &stop), Stopped);
  asker.join();
}

}  // namespace
}  // namespace cleave
