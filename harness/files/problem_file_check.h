// Whether the contents of a problem file are a problem: values, whose types and sizes are known to be right.
#pragma once

#include <string>

#include "harness/files/problem_file.h"

namespace cleave {

// Empty when all is well, else one line that names the array, the index, the value and what is allowed:
// "shape/geom_type[3] = 9, allowed: 0 to 5".
std::string find_contents_error(const ProblemFile& file);

}  // namespace cleave
