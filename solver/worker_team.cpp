#include "solver/worker_team.h"

#include <immintrin.h>
#include <omp.h>
#include <sys/resource.h>

#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace cleave {
namespace {

using Clock = std::chrono::steady_clock;

// How long a thread looks out before it sleeps. Waking one takes some ten microseconds, so gaps shorter than
// that are best spent awake; on an idle machine longer ones too, because every stage of a solve begins with a
// wake-up otherwise. On a busy machine a long look-out is taken from the thread's own share of its core,
// which it then lacks when there is work.
constexpr std::chrono::microseconds kLookOut{50}, kLongLookOut{2000};
// A thread that was pushed off its core within this time takes the machine for busy.
constexpr std::chrono::milliseconds kBusyFor{100};

template <class Condition>
bool look_out_for(Clock::duration time, Condition done) {
  constexpr int kLooksPerClock = 32;
  const auto end = Clock::now() + time;
  do {
    for (int k = 0; k < kLooksPerClock; ++k) {
      if (done()) return true;
      _mm_pause();
    }
  } while (Clock::now() < end);
  return false;
}

bool was_pushed_off_lately() {
  thread_local long switches = 0;
  thread_local Clock::time_point busy_until{};
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  const auto now = Clock::now();
  if (std::exchange(switches, usage.ru_nivcsw) != usage.ru_nivcsw) busy_until = now + kBusyFor;
  return now < busy_until;
}

// CLEAVE_LOOK_OUT_US in the environment: so many microseconds, whatever the machine does. Throws
// std::invalid_argument where it is no number.
const std::optional<Clock::duration>& asked_look_out() {
  static const std::optional<Clock::duration> asked = []() -> std::optional<Clock::duration> {
    const char* text = std::getenv("CLEAVE_LOOK_OUT_US");
    if (text == nullptr) return std::nullopt;
    int microseconds = -1;
    const char* end = text + std::strlen(text);
    const auto [last, error] = std::from_chars(text, end, microseconds);
    if (error != std::errc{} || last != end || microseconds < 0)
      throw std::invalid_argument("CLEAVE_LOOK_OUT_US: '" + std::string(text) +
                                  "' is not a whole number of microseconds in [0, 2147483647]");
    return std::chrono::microseconds(microseconds);
  }();
  return asked;
}

// Whether `done` came true before it was time to sleep.
template <class Condition>
bool look_out(Condition done) {
  if (asked_look_out()) return look_out_for(*asked_look_out(), done);
  return look_out_for(kLookOut, done) || (!was_pushed_off_lately() && look_out_for(kLongLookOut, done));
}

constexpr std::uint64_t kTasks = 0xffffffff;  // lower half of open_

// OpenMP ends the program where the system makes no more threads. So as many are made by somebody who says so.
void check_threads(int count) {
  std::atomic<bool> all_made{false};
  std::vector<std::thread> threads;
  threads.reserve(count);
  std::string refusal;
  try {
    while (static_cast<int>(threads.size()) < count)
      threads.emplace_back([&all_made] { all_made.wait(false); });
  } catch (const std::system_error& error) {
    refusal = "the system makes " + std::to_string(threads.size()) + " of " + std::to_string(count) +
              " threads: " + error.what();
  }
  all_made = true;
  all_made.notify_all();
  for (std::thread& thread : threads) thread.join();
  if (!refusal.empty()) throw std::runtime_error(refusal);
}

}  // namespace

void wait_until(std::atomic<int>& counter, int at_least) {
  const auto reached = [&] { return counter.load(std::memory_order_acquire) >= at_least; };
  if (reached() || look_out(reached)) return;
  for (int seen = counter; seen < at_least; seen = counter) counter.wait(seen);
}

void raise(std::atomic<int>& counter) {
  counter.fetch_add(1, std::memory_order_acq_rel);
  counter.notify_all();
}

WorkerTeam::WorkerTeam(int threads) : threads_(threads) {
  if (threads == 1) return;
  asked_look_out();  // its error belongs to the caller
  check_threads(threads);
  // The first member of the region has the place of the caller and only waits for the others.
  workers_ = std::thread([this] {
#pragma omp parallel num_threads(threads_)
    {
      if (omp_get_thread_num() == 0) {
        granted_ = omp_get_num_threads();
        granted_.notify_all();
      } else {
        work();
      }
    }
  });
  granted_.wait(0);
  if (granted_ == threads_) return;
  dismiss();
  throw std::runtime_error("OpenMP grants " + std::to_string(granted_) + " of " + std::to_string(threads_) +
                           " threads; OMP_THREAD_LIMIT and OMP_DYNAMIC bound them");
}

WorkerTeam::~WorkerTeam() {
  if (threads_ > 1) dismiss();
}

void WorkerTeam::dismiss() {
  stop_ = true;
  open_.fetch_add(kTasks + 1);  // a stage without tasks, so that sleepers see a change
  open_.notify_all();
  // OpenMP ends the program from that thread where the system makes no more.
  if (workers_.get_id() == std::this_thread::get_id()) return workers_.detach();
  workers_.join();
}

WorkerTeam& WorkerTeam::shared(int threads) {
  static std::mutex mutex;
  static std::map<int, std::unique_ptr<WorkerTeam>> teams;
  const std::scoped_lock lock(mutex);
  std::unique_ptr<WorkerTeam>& team = teams[threads];
  if (team == nullptr) team = std::make_unique<WorkerTeam>(threads);
  return *team;
}

void WorkerTeam::finish_one() {
  if (unfinished_.fetch_sub(1, std::memory_order_acq_rel) == 1) unfinished_.notify_all();
}

// Runs the next task that nobody has started; false when there is none.
bool WorkerTeam::take_one() {
  std::uint64_t open = open_.load(std::memory_order_acquire);
  do {
    if ((open & kTasks) == 0) return false;
  } while (!open_.compare_exchange_weak(open, open - 1, std::memory_order_acq_rel));
  const int index = count_ - static_cast<int>(open & kTasks);
  if (!failed_.load(std::memory_order_acquire)) {
    try {
      task_(context_, index);
    } catch (...) {
      if (!failed_.exchange(true)) failure_ = std::current_exception();
    }
  }
  finish_one();
  return true;
}

void WorkerTeam::work() {
  while (!stop_) {
    while (take_one()) {
    }
    const std::uint64_t seen = open_.load(std::memory_order_acquire);
    if ((seen & kTasks) != 0 || stop_) continue;
    if (look_out([&] { return open_.load(std::memory_order_acquire) != seen; })) continue;
    open_.wait(seen);
  }
}

void WorkerTeam::run(int count, Task task, void* context) {
  if (count <= 0) return;
  const std::scoped_lock lock(one_caller_);
  task_ = task;
  context_ = context;
  count_ = count;
  failed_ = false;
  unfinished_.store(count, std::memory_order_release);
  const std::uint64_t stage = (open_.load() & ~kTasks) + kTasks + 1;
  open_.store(stage + static_cast<std::uint64_t>(count), std::memory_order_release);
  open_.notify_all();
  while (take_one()) {
  }
  const auto all_done = [&] { return unfinished_.load(std::memory_order_acquire) == 0; };
  if (!look_out(all_done)) {
    for (int left = unfinished_; left != 0; left = unfinished_) unfinished_.wait(left);
  }
  if (failed_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

}  // namespace cleave
