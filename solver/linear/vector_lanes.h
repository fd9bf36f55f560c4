// Vectors of 2, 4 or 8 doubles: what the tiles of dense algebra are made of. To be included only by files
// whose instruction set is known: one each (dense_tiles_avx2.cpp, dense_tiles_avx512.cpp) or that of the
// whole program, which has the first four lanes (dense_block.cpp, block_substitution.cpp, block_matrix.cpp).
// Everything here is local to the file that includes it, so that no instruction of one set ends up in the
// other.
//
// Multiply-adds are always fused and always written out: the compiler does not decide where one is rounded.
#pragma once

#include <immintrin.h>

namespace cleave {
namespace {

template <int Lanes>
struct VectorOf;

template <>
struct VectorOf<2> {
  using Type = __m128d;
  static Type load(const double* p) { return _mm_loadu_pd(p); }
  static void store(double* p, Type v) { _mm_storeu_pd(p, v); }
  static Type all(double value) { return _mm_set1_pd(value); }
  static Type multiply_add(Type a, Type b, Type c) { return _mm_fmadd_pd(a, b, c); }
};

template <>
struct VectorOf<4> {
  using Type = __m256d;
  static Type load(const double* p) { return _mm256_loadu_pd(p); }
  static void store(double* p, Type v) { _mm256_storeu_pd(p, v); }
  static Type all(double value) { return _mm256_set1_pd(value); }
  static Type multiply_add(Type a, Type b, Type c) { return _mm256_fmadd_pd(a, b, c); }
};

#ifdef __AVX512F__
template <>
struct VectorOf<8> {
  using Type = __m512d;
  static Type load(const double* p) { return _mm512_loadu_pd(p); }
  static void store(double* p, Type v) { _mm512_storeu_pd(p, v); }
  static Type all(double value) { return _mm512_set1_pd(value); }
  static Type multiply_add(Type a, Type b, Type c) { return _mm512_fmadd_pd(a, b, c); }
};
constexpr int kWidestLanes = 8;
#else
constexpr int kWidestLanes = 4;
#endif

template <int Lanes>
using Vector = typename VectorOf<Lanes>::Type;

template <int Lanes>
inline Vector<Lanes> load(const double* p) {
  return VectorOf<Lanes>::load(p);
}

// Four numbers of which two and two may have been stored just now: a load that is not within one store waits
// for memory.
inline Vector<4> load_halves(const double* p) {
  return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(p)), _mm_loadu_pd(p + 2), 1);
}

template <int Lanes>
inline void store(double* p, Vector<Lanes> v) {
  VectorOf<Lanes>::store(p, v);
}

// How a vector is read and written: whole, or the first of its lanes, where the others are zero and what is
// in their places stays.
template <int Lanes>
struct WholeVector {
  Vector<Lanes> read(const double* p) const { return load<Lanes>(p); }
  void write(double* p, Vector<Lanes> v) const { store<Lanes>(p, v); }
};

#ifdef __AVX512F__
class FirstLanes {
 public:
  explicit FirstLanes(int count) : mask_(static_cast<__mmask8>((1 << count) - 1)) {}
  Vector<8> read(const double* p) const { return _mm512_maskz_loadu_pd(mask_, p); }
  void write(double* p, Vector<8> v) const { _mm512_mask_storeu_pd(p, mask_, v); }

 private:
  __mmask8 mask_;
};
#endif

template <int Lanes>
inline Vector<Lanes> all(double value) {
  return VectorOf<Lanes>::all(value);
}

// a b + c in one rounding
template <int Lanes>
inline Vector<Lanes> multiply_add(Vector<Lanes> a, Vector<Lanes> b, Vector<Lanes> c) {
  return VectorOf<Lanes>::multiply_add(a, b, c);
}

}  // namespace
}  // namespace cleave
