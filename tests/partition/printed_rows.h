// How GoogleTest prints the parameter of a failed test that loops over the registry.
#pragma once

#include <ostream>

#include "partition/registry.h"

namespace cleave {

inline void PrintTo(const PartitionerEntry& entry, std::ostream* out) { *out << entry.name; }
inline void PrintTo(const RefinerEntry& entry, std::ostream* out) { *out << entry.name; }

}  // namespace cleave
