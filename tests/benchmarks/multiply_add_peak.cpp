#include "tests/benchmarks/multiply_add_peak.h"

#include <immintrin.h>

#include <stdexcept>
#include <string>

namespace cleave {
namespace {

constexpr int kChains = 12;  // two ports with a latency of four need eight

// In assembler, so that the chains stay in registers: x <- x f + f in each of twelve.
#define CLEAVE_MULTIPLY_ADD(K) "vfmadd213pd %[factor], %[factor], %[x" #K "]\n\t"
#define CLEAVE_ROUND(CONSTRAINT)                                                                           \
  asm volatile(CLEAVE_MULTIPLY_ADD(0) CLEAVE_MULTIPLY_ADD(1) CLEAVE_MULTIPLY_ADD(2) CLEAVE_MULTIPLY_ADD(3) \
                   CLEAVE_MULTIPLY_ADD(4) CLEAVE_MULTIPLY_ADD(5) CLEAVE_MULTIPLY_ADD(6)                    \
                       CLEAVE_MULTIPLY_ADD(7) CLEAVE_MULTIPLY_ADD(8) CLEAVE_MULTIPLY_ADD(9)                \
                           CLEAVE_MULTIPLY_ADD(10) CLEAVE_MULTIPLY_ADD(11)                                 \
               : [x0] "+" CONSTRAINT(x0), [x1] "+" CONSTRAINT(x1), [x2] "+" CONSTRAINT(x2),                \
                 [x3] "+" CONSTRAINT(x3), [x4] "+" CONSTRAINT(x4), [x5] "+" CONSTRAINT(x5),                \
                 [x6] "+" CONSTRAINT(x6), [x7] "+" CONSTRAINT(x7), [x8] "+" CONSTRAINT(x8),                \
                 [x9] "+" CONSTRAINT(x9), [x10] "+" CONSTRAINT(x10), [x11] "+" CONSTRAINT(x11)             \
               : [factor] CONSTRAINT(factor))

[[gnu::target("avx2,fma")]] void multiply_adds_avx2(int rounds) {
  const __m256d factor = _mm256_set1_pd(0.5);
  __m256d x0 = factor, x1 = factor, x2 = factor, x3 = factor, x4 = factor, x5 = factor, x6 = factor,
          x7 = factor, x8 = factor, x9 = factor, x10 = factor, x11 = factor;
  for (int round = 0; round < rounds; ++round) CLEAVE_ROUND("x");
}

[[gnu::target("avx512f")]] void multiply_adds_avx512(int rounds) {
  const __m512d factor = _mm512_set1_pd(0.5);
  __m512d x0 = factor, x1 = factor, x2 = factor, x3 = factor, x4 = factor, x5 = factor, x6 = factor,
          x7 = factor, x8 = factor, x9 = factor, x10 = factor, x11 = factor;
  for (int round = 0; round < rounds; ++round) CLEAVE_ROUND("v");
}

}  // namespace

double run_multiply_adds(const char* instruction_set, int rounds) {
  const std::string name = instruction_set;
  if (name == "AVX2") {
    multiply_adds_avx2(rounds);
    return 2.0 * 4 * kChains * rounds;
  }
  if (name == "AVX-512") {
    multiply_adds_avx512(rounds);
    return 2.0 * 8 * kChains * rounds;
  }
  throw std::invalid_argument("no multiply-adds of '" + name + "'");
}

}  // namespace cleave
