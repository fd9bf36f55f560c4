// A vector of four doubles in the compiler's own terms, for headers and files that need no instruction by
// name (vector_lanes.h has those).
#pragma once

#include <cstring>

namespace cleave {

using FourLanes [[gnu::vector_size(4 * sizeof(double))]] = double;

// Of a double or FourLanes at p.
template <class Value>
Value read(const double* p) {
  Value value;
  std::memcpy(&value, p, sizeof value);
  return value;
}
template <class Value>
void write(Value value, double* p) {
  std::memcpy(p, &value, sizeof value);
}

}  // namespace cleave
