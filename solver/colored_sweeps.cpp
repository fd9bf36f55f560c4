#include "solver/colored_sweeps.h"

#include <immintrin.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>

namespace cleave {
namespace {

constexpr int kSideBySide = 6;   // groups that one core works on at a time
constexpr int kWordColors = 64;  // colours in one word of used_colors_
constexpr int kChunkRows = 384;  // of a task, about two microseconds

// One group on its way through its rows: the velocities of its two bodies stay in registers.
struct Traveller {
  const double *jacobian, *mass_jacobian;
  int row, rows_left;
  __m256d u[3];
};

struct Arrays {
  const StepProblem& problem;
  const double* mass_jacobian;
  const double* inverse_diagonal;
  double *impulse, *v;
};

inline void load(const Arrays& arrays, const RowGroup& g, Traveller& t) {
  alignas(32) double both[12] = {};
  std::copy_n(arrays.v + 6L * g.body_a, 6, both);
  if (g.body_b >= 0) std::copy_n(arrays.v + 6L * g.body_b, 6, both + 6);
  for (int k = 0; k < 3; ++k) t.u[k] = _mm256_load_pd(both + 4 * k);
  t.jacobian = arrays.problem.jacobian.data() + 12L * g.first_row;
  t.mass_jacobian = arrays.mass_jacobian + 12L * g.first_row;
  t.row = g.first_row;
  t.rows_left = g.row_count;
}

inline void store(const Arrays& arrays, const RowGroup& g, const Traveller& t) {
  alignas(32) double both[12];
  for (int k = 0; k < 3; ++k) _mm256_store_pd(both + 4 * k, t.u[k]);
  std::copy_n(both, 6, arrays.v + 6L * g.body_a);
  if (g.body_b >= 0) std::copy_n(both + 6, 6, arrays.v + 6L * g.body_b);
}

// The next row of each. Every traveller's arithmetic is its own: it does not matter which others are beside it.
template <int Count>
inline void advance(const Arrays& arrays, Traveller* travellers) {
  double change[Count];
  for (int i = 0; i < Count; ++i) {
    const Traveller& t = travellers[i];
    __m256d sum = _mm256_mul_pd(_mm256_loadu_pd(t.jacobian), t.u[0]);
    sum = _mm256_fmadd_pd(_mm256_loadu_pd(t.jacobian + 4), t.u[1], sum);
    sum = _mm256_fmadd_pd(_mm256_loadu_pd(t.jacobian + 8), t.u[2], sum);
    const __m128d half = _mm_add_pd(_mm256_castpd256_pd128(sum), _mm256_extractf128_pd(sum, 1));
    const double jv = _mm_cvtsd_f64(_mm_add_sd(half, _mm_unpackhi_pd(half, half)));
    const int r = t.row;
    const StepProblem& p = arrays.problem;
    const double old = arrays.impulse[r];
    // Of lambda - w / d, all but the product with J is known before the velocities are.
    const double inverse = arrays.inverse_diagonal[r];
    const double still = old - (p.compliance[r] * old - p.rhs[r]) * inverse;
    const double next = std::min(std::max(std::fma(-jv, inverse, still), p.lower[r]), p.upper[r]);
    arrays.impulse[r] = next;
    change[i] = next - old;
  }
  for (int i = 0; i < Count; ++i) {
    Traveller& t = travellers[i];
    const __m256d step = _mm256_set1_pd(change[i]);
    for (int k = 0; k < 3; ++k)
      t.u[k] = _mm256_fmadd_pd(_mm256_loadu_pd(t.mass_jacobian + 4 * k), step, t.u[k]);
    t.jacobian += 12, t.mass_jacobian += 12, ++t.row, --t.rows_left;
  }
}

// `Count` groups side by side, or as many as there are left.
template <int Count>
void visit_set(const Arrays& arrays, std::span<const RowGroup> groups, std::span<const int> which) {
  if constexpr (Count > 1) {
    if (static_cast<int>(which.size()) < Count) return visit_set<Count - 1>(arrays, groups, which);
  }
  Traveller travellers[Count];
  for (int i = 0; i < Count; ++i) load(arrays, groups[which[i]], travellers[i]);
  // Longer ones come first, so the last of them has the fewest rows.
  while (travellers[Count - 1].rows_left > 0) advance<Count>(arrays, travellers);
  for (int i = 0; i < Count; ++i) {
    while (travellers[i].rows_left > 0) advance<1>(arrays, travellers + i);
    store(arrays, groups[which[i]], travellers[i]);
  }
}

// Of the groups of one colour.
void visit(const Arrays& arrays, std::span<const RowGroup> groups, std::span<const int> which) {
  for (std::size_t begin = 0; begin < which.size(); begin += kSideBySide) {
    const std::size_t count = std::min<std::size_t>(kSideBySide, which.size() - begin);
    visit_set<kSideBySide>(arrays, groups, which.subspan(begin, count));
  }
}

}  // namespace

void ColoredSweeps::bind(const PreparedStep& step) {
  assert(step.set().axes().empty());
  step_ = &step;
  inverse_diagonal_.resize(step.row_count());
  for (int r = 0; r < step.row_count(); ++r) inverse_diagonal_[r] = 1 / step.diagonal()[r];
  color_groups(step);
  sort_by_color(step);
  cut_into_chunks(step);
}

// The first colour that neither body has. A body in very many groups needs more than a word of them.
void ColoredSweeps::color_groups(const PreparedStep& step) {
  std::size_t most = 0;
  for (int body = 0; body < step.body_count(); ++body) most = std::max(most, step.sides_of_body(body).size());
  const std::size_t words = (2 * most + kWordColors) / kWordColors;
  used_colors_.assign(words * step.body_count(), 0);
  color_of_group_.clear();
  int count = 0;
  for (const RowGroup& g : step.groups()) {
    std::uint64_t* a = used_colors_.data() + words * g.body_a;
    std::uint64_t* b = g.body_b >= 0 ? used_colors_.data() + words * g.body_b : a;
    std::size_t word = 0;
    while (~(a[word] | b[word]) == 0) ++word;
    const int bit = std::countr_one(a[word] | b[word]);
    a[word] |= std::uint64_t{1} << bit;
    b[word] |= std::uint64_t{1} << bit;
    color_of_group_.push_back(static_cast<int>(kWordColors * word) + bit);
    count = std::max(count, color_of_group_.back() + 1);
  }
  color_first_.assign(count + 1, 0);
}

void ColoredSweeps::sort_by_color(const PreparedStep& step) {
  groups_.resize(color_of_group_.size());
  for (const int color : color_of_group_) ++color_first_[color + 1];
  std::partial_sum(color_first_.begin(), color_first_.end(), color_first_.begin());
  order_.assign(color_first_.begin(), color_first_.end());
  for (std::size_t g = 0; g < groups_.size(); ++g)
    groups_[order_[color_of_group_[g]]++] = static_cast<int>(g);
  const auto rows = [&](int g) { return step.groups()[g].row_count; };
  for (int color = 0; color < color_count(); ++color) {
    std::sort(groups_.begin() + color_first_[color], groups_.begin() + color_first_[color + 1],
              [&](int a, int b) { return rows(a) != rows(b) ? rows(a) > rows(b) : a < b; });
  }
}

void ColoredSweeps::cut_into_chunks(const PreparedStep& step) {
  chunks_.clear();
  chunk_first_.assign(1, 0);
  for (int color = 0; color < color_count(); ++color) {
    int rows = 0, first = color_first_[color];
    for (int i = first; i < color_first_[color + 1]; ++i) {
      rows += step.groups()[groups_[i]].row_count;
      if (i + 1 < color_first_[color + 1] && (rows < kChunkRows || (i + 1 - first) % kSideBySide != 0))
        continue;
      chunks_.push_back({first, i + 1});
      first = i + 1;
      rows = 0;
    }
    chunk_first_.push_back(static_cast<int>(chunks_.size()));
  }
}

void ColoredSweeps::run(int sweeps, std::span<double> impulse, std::span<double> v,
                        ParallelTasks& tasks) const {
  const Arrays arrays{step_->problem(), step_->mass_jacobian().data(), inverse_diagonal_.data(),
                      impulse.data(), v.data()};
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    check_stop(tasks.stop());
    for (int color = 0; color < color_count(); ++color) {
      const int first = chunk_first_[color];
      tasks.run(chunk_first_[color + 1] - first, [&](int i) {
        const Chunk& chunk = chunks_[first + i];
        visit(arrays, step_->groups(), std::span(groups_).subspan(chunk.first, chunk.last - chunk.first));
      });
    }
  }
}

}  // namespace cleave
