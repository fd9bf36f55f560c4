// What an option, a parameter or a column is about: whoever averages or compares rows asks this and needs no
// names.
#pragma once

namespace cleave {

enum class About {
  problem,      // the world, its constraints, or what is asked of a step
  partition,    // how bodies are split
  solver,       // makes a solver another one
  bookkeeping,  // which rows there are and where they go
  measured      // columns only: what came out
};

constexpr const char* to_string(About about) {
  constexpr const char* names[] = {"problem", "partition", "solver", "bookkeeping", "measured"};
  return names[static_cast<int>(about)];
}

}  // namespace cleave
