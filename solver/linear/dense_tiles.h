// The innermost loops of dense algebra, compiled once for each instruction set: AVX2 with fused
// multiply-adds, which every machine that can run this program has, and AVX-512. The widest that the
// processor has is chosen once, when the program starts. Both give the same bytes (see block_tiles.h and
// panel_tiles.h).
//
// Adding an instruction set: a file dense_tiles_NAME.cpp, its compile option in CMakeLists.txt, and a
// question and a row in dense_tiles.cpp.
#pragma once

#include <span>

namespace cleave {

// What the functions do is said in dense_block.h and dense_panel.h, where they are called by name.
struct DenseTiles {
  const char* name;  // of the instruction set
  bool (*is_supported)();

  void (*subtract_product)(int rows, int depth, const double* a, int lda, const double* b, int ldb, double* c,
                           int ldc);
  void (*write_negative_product)(int rows, int depth, const double* a, int lda, const double* b, int ldb,
                                 double* c, int ldc);
  void (*multiply_by_transpose)(int rows, const double* w, int ldw, double* c, int ldc);
  bool (*weighted_gram)(int bodies, int rows, const double* jacobian, const double* d, double* h);

  void (*subtract_panel_product)(int depth, const double* a, const double* b, double* c);
  void (*multiply_panel_by_transpose)(const double* w, int first_row, double* c);
  void (*subtract_panel_vector)(int columns, const double* panel, const double* x, double* y);
  void (*subtract_panel_transpose)(int columns, const double* panel, const double* y, double* x);
};

// Asked here, in code for any processor, and not where the tiles are compiled.
bool processor_has_avx2();
bool processor_has_avx512();

// All that were compiled, the widest first; the last is supported everywhere.
std::span<const DenseTiles* const> all_dense_tiles();

extern const DenseTiles* chosen_dense_tiles;
inline const DenseTiles& dense_tiles() { return *chosen_dense_tiles; }

// Takes others from now on, for tests and benchmarks that compare them; not while a solver runs.
inline void use_dense_tiles(const DenseTiles& tiles) { chosen_dense_tiles = &tiles; }

}  // namespace cleave
