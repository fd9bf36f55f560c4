// A child that does not outlive its parent, however that ends.
#pragma once

#include <sys/types.h>

namespace cleave {

// Right after fork, in the child; parent: what ::getpid() said before. Allocates nothing. Ends the child at
// once where its parent has ended before.
void end_with_parent(pid_t parent);

}  // namespace cleave
