// Seeded random numbers by explicit arithmetic: the standard fixes the generator but not its distributions.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>

namespace cleave {

class SceneRandom {
 public:
  explicit SceneRandom(std::uint64_t seed) : generator_(seed) {}

  // Uniform in [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(generator_() >> 11) * 0x1p-53);
  }

  // Uniform in 0 .. count - 1.
  std::size_t index(std::size_t count) {
    return static_cast<std::size_t>(uniform(0, static_cast<double>(count)));
  }

  // Uniform rotation, quaternion w x y z (Shoemake, Uniform random rotations, Graphics Gems III, 1992).
  std::array<double, 4> rotation() {
    const double u = uniform(0, 1);
    const double a = uniform(0, 2 * std::numbers::pi), b = uniform(0, 2 * std::numbers::pi);
    const double p = std::sqrt(1 - u), q = std::sqrt(u);
    return {p * std::sin(a), p * std::cos(a), q * std::sin(b), q * std::cos(b)};
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace cleave
