// What a problem file may leave out, and what it then means (PROBLEM_FILES.md).
#pragma once

#include "harness/files/problem_file.h"

namespace cleave {

// Fills every array that is empty because the file does not have it. The arrays that a file must have are
// there.
void fill_left_out(ProblemFile& file);

}  // namespace cleave
