#include "solver/slab_rows.h"

#include <immintrin.h>

#include <algorithm>
#include <cmath>

namespace cleave {
namespace {

constexpr int kSideBySide = 6;  // groups that one core works on at a time

// A group of rows on its way: the velocities of its two bodies stay in registers.
struct Traveller {
  const SlabRow* row;
  float* impulse;
  int rows_left;
  __m256 u_a, u_b;
};

inline void load(const SlabArrays& arrays, int group, Traveller& t) {
  const RowGroup& g = arrays.groups[group];
  t.u_a = _mm256_load_ps(arrays.bodies[arrays.place_of_body[g.body_a]].velocity);
  t.u_b =
      _mm256_load_ps(arrays.bodies[g.body_b < 0 ? arrays.still : arrays.place_of_body[g.body_b]].velocity);
  t.row = arrays.rows + arrays.place_of_group[group];
  t.impulse = arrays.impulse + arrays.place_of_group[group];
  t.rows_left = g.row_count;
}

inline void store(const SlabArrays& arrays, int group, const Traveller& t) {
  const RowGroup& g = arrays.groups[group];
  _mm256_store_ps(arrays.bodies[arrays.place_of_body[g.body_a]].velocity, t.u_a);
  if (g.body_b >= 0) _mm256_store_ps(arrays.bodies[arrays.place_of_body[g.body_b]].velocity, t.u_b);
}

inline float sum_of(__m256 x) {
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(x), _mm256_extractf128_ps(x, 1));
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_movehdup_ps(two)));
}

// The next row of each. Every traveller's arithmetic is its own: it does not matter which others are beside it.
template <int Count>
inline void advance(Traveller* travellers) {
  float change[Count];
  for (int i = 0; i < Count; ++i) {
    const Traveller& t = travellers[i];
    const SlabRow& row = *t.row;
    const float jv = sum_of(_mm256_fmadd_ps(_mm256_load_ps(row.jacobian_b), t.u_b,
                                            _mm256_mul_ps(_mm256_load_ps(row.jacobian_a), t.u_a)));
    const float old = *t.impulse;
    const float next =
        std::min(std::max(std::fma(old, row.kept(), row.push()) - jv, row.lower()), row.upper());
    change[i] = next - old;
    *t.impulse = next;
  }
  for (int i = 0; i < Count; ++i) {
    Traveller& t = travellers[i];
    const __m256 step = _mm256_set1_ps(change[i]);
    t.u_a = _mm256_fmadd_ps(_mm256_load_ps(t.row->mass_jacobian_a), step, t.u_a);
    t.u_b = _mm256_fmadd_ps(_mm256_load_ps(t.row->mass_jacobian_b), step, t.u_b);
    ++t.row, ++t.impulse, --t.rows_left;
  }
}

// `Count` groups side by side, or as many as there are left.
template <int Count>
void visit_set(const SlabArrays& arrays, std::span<const int> which) {
  if constexpr (Count > 1) {
    if (static_cast<int>(which.size()) < Count) return visit_set<Count - 1>(arrays, which);
  }
  Traveller travellers[Count];
  for (int i = 0; i < Count; ++i) load(arrays, which[i], travellers[i]);
  // Longer ones come first, so the last of them has the fewest rows.
  while (travellers[Count - 1].rows_left > 0) advance<Count>(travellers);
  for (int i = 0; i < Count; ++i) {
    while (travellers[i].rows_left > 0) advance<1>(travellers + i);
    store(arrays, which[i], travellers[i]);
  }
}

}  // namespace

void visit_groups(const SlabArrays& arrays, std::span<const int> which) {
  for (std::size_t begin = 0; begin < which.size(); begin += kSideBySide) {
    const std::size_t count = std::min<std::size_t>(kSideBySide, which.size() - begin);
    visit_set<kSideBySide>(arrays, which.subspan(begin, count));
  }
}

}  // namespace cleave
