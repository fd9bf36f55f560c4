#pragma once

#include <hdf5.h>

#include "tests/fuzz/recipe.h"

namespace cleave::fuzz {

// Edits an open problem file until the recipe is over or says so. What cannot be done is left.
void edit_problem(Recipe& recipe, hid_t file);

}  // namespace cleave::fuzz
