// The tiles of the instruction set that the including file is compiled for.
#pragma once

#include "solver/linear/block_tiles.h"
#include "solver/linear/dense_tiles.h"
#include "solver/linear/panel_tiles.h"

namespace cleave {
namespace {

constexpr DenseTiles tiles_of(const char* name, bool (*is_supported)()) {
  return {name,
          is_supported,
          subtract_product_tiled<Begin::at_what_is_there>,
          subtract_product_tiled<Begin::at_zero>,
          multiply_by_transpose_tiled,
          weighted_gram_tiled,
          subtract_panel_product_tiled,
          multiply_panel_by_transpose_tiled,
          subtract_panel_vector_tiled,
          subtract_panel_transpose_tiled};
}

}  // namespace
}  // namespace cleave
