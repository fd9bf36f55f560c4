// Random numbers of the tests: the same on every machine, because the standard's distributions are not
// specified.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace cleave {

class SeededRandom {
 public:
  explicit SeededRandom(std::uint64_t seed) : generator_(seed) {}

  double uniform(double least, double most) {
    return least + (most - least) * (static_cast<double>(generator_() >> 11) * 0x1p-53);
  }
  double log_uniform(double least, double most) { return std::exp(uniform(std::log(least), std::log(most))); }
  int integer(int least, int most) {  // both ends included
    return least + static_cast<int>(generator_() % static_cast<std::uint64_t>(most - least + 1));
  }
  bool chance(double probability) { return uniform(0, 1) < probability; }

 private:
  std::mt19937_64 generator_;
};

}  // namespace cleave
