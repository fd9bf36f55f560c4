// The tiles of dense algebra for AVX2 with fused multiply-adds.
#include "solver/linear/dense_tiles_table.h"

namespace cleave {

extern constinit const DenseTiles kDenseTilesAvx2 = tiles_of("AVX2", processor_has_avx2);

}  // namespace cleave
