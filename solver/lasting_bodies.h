// Bodies to be eliminated before all others of their part, as their columns of the factor last.
//
// Rows without bounds hold as equations whatever the active set is, and keep their weight from one
// factorisation of a solve to the next. So columns of bodies that have no other rows are made once, where
// nothing that changes is eliminated before them. To put them first costs nothing where a body has rows with
// at most two others, as a link of a chain or of a cable has: eliminating it leaves no more than the pair of
// these two behind.
#pragma once

#include <vector>

#include "solver/prepared_step.h"

namespace cleave {

// lasting: (n) becomes 1 for these bodies. Returns whether there is one.
bool find_lasting_bodies(const PreparedStep& step, std::vector<char>& lasting);

}  // namespace cleave
