// Loaded before a program (LD_PRELOAD): its wall clock is up to ten days wrong, in every process and at every
// question otherwise.
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <ctime>

namespace {

std::atomic<int> questions{0};

std::time_t jump_s() {
  constexpr int kDay_s = 86400, kDays = 21;
  return static_cast<std::time_t>((questions++ + ::getpid()) % kDays - kDays / 2) * kDay_s;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const long code = ::syscall(SYS_clock_gettime, clock, time);
  if (code == 0 && clock == CLOCK_REALTIME) time->tv_sec += jump_s();
  return static_cast<int>(code);
}

extern "C" std::time_t time(std::time_t* where) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (where != nullptr) *where = now.tv_sec;
  return now.tv_sec;
}
