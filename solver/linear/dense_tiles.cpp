#include "solver/linear/dense_tiles.h"

#include <algorithm>
#include <iterator>

namespace cleave {

extern const DenseTiles kDenseTilesAvx512, kDenseTilesAvx2;

namespace {

constexpr const DenseTiles* kAll[] = {&kDenseTilesAvx512, &kDenseTilesAvx2};

}  // namespace

bool processor_has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
bool processor_has_avx512() { return __builtin_cpu_supports("avx512f"); }

std::span<const DenseTiles* const> all_dense_tiles() { return kAll; }

const DenseTiles* chosen_dense_tiles = *std::ranges::find_if(
    kAll, [](const DenseTiles* tiles) { return tiles == std::end(kAll)[-1] || tiles->is_supported(); });

}  // namespace cleave
