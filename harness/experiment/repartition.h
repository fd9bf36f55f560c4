// When a step is split anew and when it takes over the parts of the step before (--repartition).
#pragma once

#include <string>

namespace cleave {

struct Repartition {
  enum class Kind { always, on_change, every, drift };

  Kind kind = Kind::always;
  int steps = 1;                // of every: from one new partition to the next
  double drift = 0;             // of drift: by how much of itself the share of cut rows may grow
  std::string text = "always";  // as given
};

// "always", "on-change", "every:K" with K >= 1 or "drift:X" with X >= 0. Throws std::invalid_argument naming
// the option.
Repartition read_repartition(const std::string& option, const std::string& text);

}  // namespace cleave
