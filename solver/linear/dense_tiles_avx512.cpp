// The tiles of dense algebra for AVX-512.
#include "solver/linear/dense_tiles_table.h"

namespace cleave {

extern constinit const DenseTiles kDenseTilesAvx512 = tiles_of("AVX-512", processor_has_avx512);

}  // namespace cleave
