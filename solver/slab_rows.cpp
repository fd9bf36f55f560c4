#include "solver/slab_rows.h"

#include <immintrin.h>

namespace cleave {
namespace {

// Eight vectors of eight numbers to eight of the first numbers, of the second, ...
inline void transpose(__m256* v) {
  __m256 pairs[8], fours[8];
  for (int i = 0; i < 4; ++i) {
    pairs[2 * i] = _mm256_unpacklo_ps(v[2 * i], v[2 * i + 1]);
    pairs[2 * i + 1] = _mm256_unpackhi_ps(v[2 * i], v[2 * i + 1]);
  }
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < 2; ++k) {
      fours[4 * i + 2 * k] = _mm256_shuffle_ps(pairs[4 * i + k], pairs[4 * i + 2 + k], 0x44);
      fours[4 * i + 2 * k + 1] = _mm256_shuffle_ps(pairs[4 * i + k], pairs[4 * i + 2 + k], 0xEE);
    }
  }
  for (int i = 0; i < 4; ++i) {
    v[i] = _mm256_permute2f128_ps(fours[i], fours[4 + i], 0x20);
    v[4 + i] = _mm256_permute2f128_ps(fours[i], fours[4 + i], 0x31);
  }
}

// u[c]: the c-th number of the velocity in every lane, 0 <= c < 6. Kept out of visit_octet(), where what is
// in registers would go to memory for it.
[[gnu::noinline]] void load(const SlabBody* bodies, const int* places, __m256* u) {
  __m256 v[8];
  for (int i = 0; i < 8; ++i) v[i] = _mm256_load_ps(bodies[places[i]].velocity);
  transpose(v);
  for (int c = 0; c < 6; ++c) u[c] = v[c];
}

[[gnu::noinline]] void store(SlabBody* bodies, const int* places, const __m256* u) {
  __m256 v[8] = {u[0], u[1], u[2], u[3], u[4], u[5], _mm256_setzero_ps(), _mm256_setzero_ps()};
  transpose(v);
  for (int i = 0; i < 8; ++i) _mm256_store_ps(bodies[places[i]].velocity, v[i]);
}

// kept lambda + rest - J v / d, in four sums that do not wait for each other.
inline __m256 free_impulse(const OctetRow& row, __m256 impulse, const __m256* u) {
  __m256 sum[4];
  sum[0] = _mm256_fmadd_ps(impulse, _mm256_load_ps(row.kept), _mm256_load_ps(row.rest));
  sum[0] = _mm256_fnmadd_ps(_mm256_load_ps(row.jacobian[0]), u[0], sum[0]);
#pragma GCC unroll 3
  for (int i = 1; i < 4; ++i) sum[i] = _mm256_mul_ps(_mm256_load_ps(row.jacobian[i]), u[i]);
#pragma GCC unroll 2
  for (int c = 4; c < 12; c += 4) {
    sum[0] = _mm256_fnmadd_ps(_mm256_load_ps(row.jacobian[c]), u[c], sum[0]);
#pragma GCC unroll 3
    for (int i = 1; i < 4; ++i)
      sum[i] = _mm256_fmadd_ps(_mm256_load_ps(row.jacobian[c + i]), u[c + i], sum[i]);
  }
  return _mm256_sub_ps(_mm256_sub_ps(sum[0], sum[1]), _mm256_add_ps(sum[2], sum[3]));
}

// Adds to agreement.
inline void visit_row(OctetRow& row, __m256 share, __m256* u, __m256& agreement) {
  const __m256 before = _mm256_load_ps(row.impulse);
  const __m256 start = _mm256_fmadd_ps(share, _mm256_load_ps(row.change), before);
  const __m256 next = _mm256_min_ps(_mm256_max_ps(free_impulse(row, start, u), _mm256_load_ps(row.lower)),
                                    _mm256_load_ps(row.upper));
  const __m256 step = _mm256_sub_ps(next, start), change = _mm256_sub_ps(next, before);
  _mm256_store_ps(row.impulse, next);
  _mm256_store_ps(row.change, change);
  agreement = _mm256_fmadd_ps(step, change, agreement);
#pragma GCC unroll 12
  for (int c = 0; c < 12; ++c) u[c] = _mm256_fmadd_ps(_mm256_load_ps(row.mass_jacobian[c]), step, u[c]);
}

}  // namespace

void push_body(float share, SlabBody& body) {
  const __m256 end = _mm256_load_ps(body.velocity);
  const __m256 change = _mm256_sub_ps(end, _mm256_load_ps(body.end));
  _mm256_store_ps(body.end, end);
  _mm256_store_ps(body.velocity, _mm256_fmadd_ps(_mm256_set1_ps(share), change, end));
}

void visit_octet(const Octet& octet, float share, OctetRow* rows, SlabBody* bodies,
                 float (&agreement)[kOctetLanes]) {
  __m256 velocities[12];
  load(bodies, octet.body_a, velocities);
  load(bodies, octet.body_b, velocities + 6);
  __m256 u[12];
#pragma GCC unroll 12
  for (int c = 0; c < 12; ++c) u[c] = velocities[c];
  const __m256 shares = _mm256_set1_ps(share);
  __m256 sum = _mm256_loadu_ps(agreement);
  for (OctetRow *row = rows + octet.first_row, *end = row + octet.row_count; row != end; ++row)
    visit_row(*row, shares, u, sum);
  _mm256_storeu_ps(agreement, sum);
#pragma GCC unroll 12
  for (int c = 0; c < 12; ++c) velocities[c] = u[c];
  store(bodies, octet.body_a, velocities);
  store(bodies, octet.body_b, velocities + 6);
}

}  // namespace cleave
