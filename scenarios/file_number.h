// Numbers of a scene file that may be drawn: anew for every body, from the run's seed.
#pragma once

#include <array>
#include <vector>

#include "scenarios/scene_random.h"

namespace cleave::scene_file {

struct Number {
  double from = 0, to = 0;     // uniform in [from, to); equal: fixed
  std::vector<double> one_of;  // not empty: one of these, all equally likely

  // A fixed number draws nothing.
  double draw(SceneRandom& random) const {
    if (!one_of.empty()) return one_of[random.index(one_of.size())];
    return from == to ? from : random.uniform(from, to);
  }
};

using DrawnVector = std::array<Number, 3>;

// In the order x, y, z.
inline std::array<double, 3> draw(const DrawnVector& vector, SceneRandom& random) {
  const double x = vector[0].draw(random), y = vector[1].draw(random);
  return {x, y, vector[2].draw(random)};
}

}  // namespace cleave::scene_file
