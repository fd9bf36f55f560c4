// METIS draws from rand() of the C library, whose state the whole process shares: whoever calls METIS holds
// this lock, so that its numbers are its own.
#pragma once

#include <mutex>

namespace cleave {

inline std::mutex& metis_lock() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace cleave
