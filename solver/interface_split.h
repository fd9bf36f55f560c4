// Splits the row groups of a step at the cut of a partition: interior groups of every part, and the cut rows
// between parts (the interface). Contacts with static geometry are interior to their body's part.
#pragma once

#include <span>
#include <vector>

#include "solver/prepared_step.h"

namespace cleave {

struct PartRows {
  std::vector<int> bodies;    // by index in the problem, ascending
  std::vector<int> groups;    // interior groups
  std::vector<int> cut_rows;  // places in InterfaceSplit::cut_rows of the rows that touch this part
  std::vector<int> cut_side;  // which Jacobian block (0 or 1) of that row belongs to this part
};

struct InterfaceSplit {
  // part_of_body: (n) ids 0..parts-1. Buffers are kept from call to call.
  void split(const PreparedStep& step, std::span<const int> part_of_body);

  int part_count = 0;
  std::vector<PartRows> parts;     // (at least part_count)
  std::vector<int> local_of_body;  // (n) place of a body in its part
  std::vector<int> cut_rows;       // their rows, ascending
};

}  // namespace cleave
