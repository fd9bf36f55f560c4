#include "solver/core_round_trip.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>

#include "solver/worker_team.h"

namespace cleave {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kBatches = 4, kTrips = 50;

// What two tasks of a team say to each other. Neither waits beyond the end, so that one thread can run both.
class PingPong {
 public:
  explicit PingPong(std::chrono::nanoseconds patience) : end_(Clock::now() + patience) {}

  void take_part() {
    if (players_.fetch_add(1) == 0) {
      ask();
    } else {
      answer();
    }
  }
  double least_ns() const { return least_ns_; }

 private:
  template <class Condition>
  bool wait_until(const Condition& condition) const {
    for (int looks = 1; !condition(); ++looks) {
      if (looks % 1024 == 0 && Clock::now() > end_) return false;
    }
    return true;
  }

  void ask() {
    if (!wait_until([&] { return players_.load() == 2; })) return;
    for (int batch = 0; batch < kBatches; ++batch) {
      const auto begin = Clock::now();
      for (int trip = batch * kTrips + 1; trip <= (batch + 1) * kTrips; ++trip) {
        ping_.store(trip, std::memory_order_release);
        if (!wait_until([&] { return pong_.load(std::memory_order_acquire) == trip; })) return;
      }
      const std::chrono::duration<double, std::nano> time = Clock::now() - begin;
      const double ns = time.count() / kTrips;
      least_ns_ = batch == 0 ? ns : std::min(least_ns_, ns);
    }
  }

  void answer() {
    for (int trip = 1; trip <= kBatches * kTrips; ++trip) {
      if (!wait_until([&] { return ping_.load(std::memory_order_acquire) == trip; })) return;
      pong_.store(trip, std::memory_order_release);
    }
  }

  const Clock::time_point end_;
  double least_ns_ = std::numeric_limits<double>::quiet_NaN();
  std::atomic<int> players_{0};
  alignas(64) std::atomic<int> ping_{0};
  alignas(64) std::atomic<int> pong_{0};
};

}  // namespace

double core_round_trip_ns(int threads, std::chrono::nanoseconds patience) {
  if (threads == 1) return std::numeric_limits<double>::quiet_NaN();
  PingPong game(patience);
  WorkerTeam::shared(threads).run(
      2, [](void* context, int) { static_cast<PingPong*>(context)->take_part(); }, &game);
  return game.least_ns();
}

}  // namespace cleave
