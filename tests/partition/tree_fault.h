// What is wrong with a tree of parts, told by walking it from the root: shares no code with what makes it.
#pragma once

#include <string>

#include "partition/nested.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {

// "" when all is well, else one line. Leaves 0..parts-1 first, none empty, every parent after its children,
// one root that all nodes hang from, and at least two children of an inner node.
std::string tree_fault(const Bodies& bodies, const Partition& nested);

}  // namespace cleave::partition_test
