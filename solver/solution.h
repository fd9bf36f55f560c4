// The iterate of a solve: the warm start on the way in, the result on the way out.
#pragma once

#include <vector>

namespace cleave {

struct Solution {
  std::vector<double> impulse;   // (m) lambda, N s; in: warm start (zeros for a cold one), out: result
  std::vector<double> velocity;  // (n, 6) out: v
};

}  // namespace cleave
