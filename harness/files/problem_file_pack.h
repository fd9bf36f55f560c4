// A problem file as plain bytes, to go from the process that reads it to the one that uses it.
#pragma once

#include <string>
#include <string_view>

#include "harness/files/problem_file.h"
#include "harness/files/problem_file_hashes.h"

namespace cleave {

struct PackedProblemFile {
  ProblemFile file;
  StoredHashes hashes;  // as the file says
};

std::string pack(const PackedProblemFile& packed);

// Throws std::invalid_argument, without a file name, where the bytes are not those of a whole problem file
// whose arrays have the sizes that belong together. Allocates no more than the bytes hold.
PackedProblemFile unpack(std::string_view bytes);

}  // namespace cleave
