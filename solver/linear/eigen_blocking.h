// Eigen cuts its dense products into blocks by the sizes of this processor's caches, so the last digits of
// its results would follow the machine. Whoever uses Eigen on matrices of more than a few rows calls this
// first.
#pragma once

#include <Eigen/Core>

namespace cleave {

inline void fix_eigen_blocking() {
  constexpr std::ptrdiff_t kFirstLevelBytes = 32 << 10, kSecondLevelBytes = 512 << 10,
                           kThirdLevelBytes = 4 << 20;
  Eigen::setCpuCacheSizes(kFirstLevelBytes, kSecondLevelBytes, kThirdLevelBytes);
}

}  // namespace cleave
