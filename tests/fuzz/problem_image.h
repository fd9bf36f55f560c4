// Damaged problem files: sound ones, edited through the HDF5 library, so that what is wrong is a shape, a
// type or a value far more often than a checksum of the library's own.
#pragma once

#include <string>
#include <string_view>

namespace cleave::fuzz {

// The bytes of a file. recipe: which sound file, then one edit after the other (problem_edits.h); a recipe
// that begins as HDF5 files do is itself the file.
std::string problem_image(std::string_view recipe);

}  // namespace cleave::fuzz
