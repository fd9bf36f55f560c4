// Arrays and attributes as edits see them: numbers, whatever their type.
#pragma once

#include <hdf5.h>

#include <string>
#include <vector>

#include "harness/files/hdf5_handle.h"
#include "tests/fuzz/recipe.h"

namespace cleave::fuzz {

struct Array {
  std::vector<hsize_t> extents;
  std::vector<double> values;  // 2^53 and more are not what they were
};

Array read_array(hid_t file, const std::string& name);

// In place of what stands there. Values beyond kMostWritten are left unwritten.
void replace_array(hid_t file, const std::string& name, const Array& array, hid_t type, hid_t properties);

inline constexpr hsize_t kMostWritten = 4096;

// Some type, numeric or not, that files may hold; and some way of storing an array.
Hdf5Handle draw_type(Recipe& recipe);
Hdf5Handle draw_storage(Recipe& recipe, const std::vector<hsize_t>& extents);

}  // namespace cleave::fuzz
