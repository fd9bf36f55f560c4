// The tiles of dense algebra for AVX2 with fused multiply-adds.
#include "solver/linear/block_tiles.h"
#include "solver/linear/dense_tiles.h"
#include "solver/linear/panel_tiles.h"

namespace cleave {

extern const DenseTiles kDenseTilesAvx2 = {
    "AVX2",
    [] { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); },
    subtract_product_tiled,
    multiply_by_transpose_tiled,
    weighted_gram_tiled,
    subtract_panel_product_tiled,
    multiply_panel_by_transpose_tiled,
    subtract_panel_vector_tiled,
    subtract_panel_transpose_tiled,
};

}  // namespace cleave
