// The peers there are: rows that add_solvers (solver/registry.h) puts beside the solvers of this project. To
// add one: a function in a file named after its library, and a row here.
#pragma once

#include <vector>

#include "solver/registry.h"

namespace cleave {

// A row whose library was not there when this was built says which package to install, and cannot be made.
const std::vector<SolverRow>& peer_table();

}  // namespace cleave
