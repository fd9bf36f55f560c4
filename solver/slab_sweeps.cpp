#include "solver/slab_sweeps.h"

#include <immintrin.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <numeric>

namespace cleave {
namespace {

constexpr int kSideBySide = 6;   // groups that one core works on at a time
constexpr int kSlabRows = 600;   // about so many in a slab: five microseconds of work
constexpr int kLineDoubles = 8;  // in a cache line
constexpr int kBodyStride = kLineDoubles;
constexpr double kNoVelocity[6] = {};
constexpr int kWordColors = 64;  // colours in one word of used_colors_

// One group on its way through its rows: the velocities of its two bodies stay in registers.
struct Traveller {
  const double *jacobian, *mass_jacobian;
  double* impulse;
  int row, rows_left;
  __m256d u[3];
};

struct Arrays {
  const StepProblem& problem;
  std::span<const RowGroup> groups;
  const double* mass_jacobian;
  const double* inverse_diagonal;
  const int *place_of_body, *place_of_group;
  double *impulse, *v;  // by place
};

// u = (v of body_a, v of body_b), zero for static.
inline void load(const Arrays& arrays, int group, Traveller& t) {
  const RowGroup& g = arrays.groups[group];
  const double* a = arrays.v + static_cast<long>(kBodyStride) * arrays.place_of_body[g.body_a];
  const double* b =
      g.body_b < 0 ? kNoVelocity : arrays.v + static_cast<long>(kBodyStride) * arrays.place_of_body[g.body_b];
  t.u[0] = _mm256_loadu_pd(a);
  t.u[1] = _mm256_set_m128d(_mm_loadu_pd(b), _mm_loadu_pd(a + 4));
  t.u[2] = _mm256_loadu_pd(b + 2);
  t.jacobian = arrays.problem.jacobian.data() + 12L * g.first_row;
  t.mass_jacobian = arrays.mass_jacobian + 12L * g.first_row;
  t.impulse = arrays.impulse + arrays.place_of_group[group];
  t.row = g.first_row;
  t.rows_left = g.row_count;
}

inline void store(const Arrays& arrays, int group, const Traveller& t) {
  const RowGroup& g = arrays.groups[group];
  double* a = arrays.v + static_cast<long>(kBodyStride) * arrays.place_of_body[g.body_a];
  _mm256_storeu_pd(a, t.u[0]);
  _mm_storeu_pd(a + 4, _mm256_castpd256_pd128(t.u[1]));
  if (g.body_b < 0) return;
  double* b = arrays.v + static_cast<long>(kBodyStride) * arrays.place_of_body[g.body_b];
  _mm_storeu_pd(b, _mm256_extractf128_pd(t.u[1], 1));
  _mm256_storeu_pd(b + 2, t.u[2]);
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
    const double old = *t.impulse;
    // Of lambda - w / d, all but the product with J is known before the velocities are.
    const double inverse = arrays.inverse_diagonal[r];
    const double still = old - (p.compliance[r] * old - p.rhs[r]) * inverse;
    const double next = std::min(std::max(std::fma(-jv, inverse, still), p.lower[r]), p.upper[r]);
    *t.impulse = next;
    change[i] = next - old;
  }
  for (int i = 0; i < Count; ++i) {
    Traveller& t = travellers[i];
    const __m256d step = _mm256_set1_pd(change[i]);
    for (int k = 0; k < 3; ++k)
      t.u[k] = _mm256_fmadd_pd(_mm256_loadu_pd(t.mass_jacobian + 4 * k), step, t.u[k]);
    t.jacobian += 12, t.mass_jacobian += 12, ++t.impulse, ++t.row, --t.rows_left;
  }
}

// `Count` groups side by side, or as many as there are left.
template <int Count>
void visit_set(const Arrays& arrays, std::span<const int> which) {
  if constexpr (Count > 1) {
    if (static_cast<int>(which.size()) < Count) return visit_set<Count - 1>(arrays, which);
  }
  Traveller travellers[Count];
  for (int i = 0; i < Count; ++i) load(arrays, which[i], travellers[i]);
  // Longer ones come first, so the last of them has the fewest rows.
  while (travellers[Count - 1].rows_left > 0) advance<Count>(arrays, travellers);
  for (int i = 0; i < Count; ++i) {
    while (travellers[i].rows_left > 0) advance<1>(arrays, travellers + i);
    store(arrays, which[i], travellers[i]);
  }
}

// Of the groups of one colour.
void visit(const Arrays& arrays, std::span<const int> which) {
  for (std::size_t begin = 0; begin < which.size(); begin += kSideBySide) {
    const std::size_t count = std::min<std::size_t>(kSideBySide, which.size() - begin);
    visit_set<kSideBySide>(arrays, which.subspan(begin, count));
  }
}

}  // namespace

void SlabSweeps::bind(const PreparedStep& step) {
  assert(step.set().axes().empty());
  step_ = &step;
  inverse_diagonal_.resize(step.row_count());
  for (int r = 0; r < step.row_count(); ++r) inverse_diagonal_[r] = 1 / step.diagonal()[r];
  measure_distances(step);
  cut_slabs(step);
  color_groups(step);
  sort_groups(step);
  assign_places(step);
  build_graph();
}

// Breadth first; appends to queue_ the bodies that are reached and have no distance yet. Returns the last of them.
int SlabSweeps::walk_from(const PreparedStep& step, int start, int distance) {
  std::size_t next = queue_.size();
  distance_[start] = distance;
  for (queue_.push_back(start); next < queue_.size(); ++next) {
    const int body = queue_[next];
    for (const int side : step.sides_of_body(body)) {
      const RowGroup& g = step.groups()[side / 2];
      const int other = side % 2 == 0 ? g.body_b : g.body_a;
      if (other < 0 || distance_[other] >= 0) continue;
      distance_[other] = distance_[body] + 1;
      queue_.push_back(other);
    }
  }
  return queue_.back();
}

// From a body at the edge: the one that is reached last from the body of lowest number. Islands follow each other.
void SlabSweeps::measure_distances(const PreparedStep& step) {
  distance_.assign(step.body_count(), -1);
  queue_.clear();
  for (int body = 0, next = 0; body < step.body_count(); ++body) {
    if (distance_[body] >= 0) continue;
    const std::size_t island = queue_.size();
    const int edge = walk_from(step, body, 0);
    for (std::size_t k = island; k < queue_.size(); ++k) distance_[queue_[k]] = -1;
    queue_.resize(island);
    next = distance_[walk_from(step, edge, next)] + 1;
  }
}

// At whole distances, so that no pair of bodies reaches over a slab.
void SlabSweeps::cut_slabs(const PreparedStep& step) {
  const int most = queue_.empty() ? 0 : distance_[queue_.back()];
  rows_at_.assign(most + 1, 0);
  for (const RowGroup& g : step.groups()) rows_at_[distance_[g.body_a]] += g.row_count;
  const int wanted = std::max(1, step.row_count() / kSlabRows);
  slab_count_ = 0;
  long rows = 0;  // so far
  for (int at = 0; at <= most; ++at) {
    rows += rows_at_[at];
    rows_at_[at] = slab_count_;
    if (rows * wanted >= static_cast<long>(slab_count_ + 1) * step.row_count()) ++slab_count_;
  }
  slab_count_ = std::max(slab_count_, 1);
  slab_of_body_.resize(step.body_count());
  for (int body = 0; body < step.body_count(); ++body)
    slab_of_body_[body] = std::min(rows_at_[distance_[body]], slab_count_ - 1);
}

// Of the colours of its set that neither body has the one with the fewest groups, or a new one. A body in very many
// groups needs more than a word of colours.
void SlabSweeps::color_groups(const PreparedStep& step) {
  std::size_t most = 0;
  for (int body = 0; body < step.body_count(); ++body) most = std::max(most, step.sides_of_body(body).size());
  const std::size_t words = (2 * most + kWordColors) / kWordColors, colors = kWordColors * words;
  const int sets = 2 * slab_count_;
  used_colors_.assign(3 * words * step.body_count(), 0);  // a body is in one inside and up to two gaps
  group_count_.assign(colors * sets, 0);
  color_first_.assign(sets + 1, 0);
  set_of_group_.clear();
  color_of_group_.clear();
  for (const RowGroup& g : step.groups()) {
    const int slab_a = slab_of_body_[g.body_a], slab_b = g.body_b < 0 ? slab_a : slab_of_body_[g.body_b];
    const int low = std::min(slab_a, slab_b);
    const bool inside = slab_a == slab_b;
    const int set = inside ? low : set_of_gap(low);
    const auto used = [&](int body, int slab) {
      return used_colors_.data() + words * (3 * body + (inside ? 0 : slab == low ? 1 : 2));
    };
    std::uint64_t* a = used(g.body_a, slab_a);
    std::uint64_t* b = g.body_b < 0 ? a : used(g.body_b, slab_b);
    int* count = group_count_.data() + colors * set;
    int best = color_first_[set + 1];
    for (int color = color_first_[set + 1] - 1; color >= 0; --color) {
      const bool free = ((a[color / kWordColors] | b[color / kWordColors]) >> color % kWordColors & 1) == 0;
      if (free && (best == color_first_[set + 1] || count[color] <= count[best])) best = color;
    }
    color_first_[set + 1] = std::max(color_first_[set + 1], best + 1);
    a[best / kWordColors] |= std::uint64_t{1} << best % kWordColors;
    b[best / kWordColors] |= std::uint64_t{1} << best % kWordColors;
    ++count[best];
    set_of_group_.push_back(set);
    color_of_group_.push_back(best);
  }
  std::partial_sum(color_first_.begin(), color_first_.end(), color_first_.begin());
}

void SlabSweeps::sort_groups(const PreparedStep& step) {
  const auto place = [this](std::size_t g) { return color_first_[set_of_group_[g]] + color_of_group_[g]; };
  group_first_.assign(color_first_.back() + 1, 0);
  for (std::size_t g = 0; g < set_of_group_.size(); ++g) ++group_first_[place(g) + 1];
  std::partial_sum(group_first_.begin(), group_first_.end(), group_first_.begin());
  groups_.resize(set_of_group_.size());
  group_count_.assign(group_first_.begin(), group_first_.end());
  for (std::size_t g = 0; g < groups_.size(); ++g) groups_[group_count_[place(g)]++] = static_cast<int>(g);
  const auto rows = [&](int g) { return step.groups()[g].row_count; };
  for (std::size_t c = 0; c + 1 < group_first_.size(); ++c) {
    std::sort(groups_.begin() + group_first_[c], groups_.begin() + group_first_[c + 1],
              [&](int a, int b) { return rows(a) != rows(b) ? rows(a) > rows(b) : a < b; });
  }
}

// Insides by slab, then the gaps behind even slabs, then those behind odd ones.
int SlabSweeps::set_of_gap(int gap) const {
  const int even_gaps = slab_count_ / 2;
  return slab_count_ + (gap % 2 == 0 ? 0 : even_gaps) + gap / 2;
}

// A task waits for those before it that share a slab with it: an inside for the gaps around it of the sweep before, a gap
// for the two insides, and one behind an odd slab for the gaps around it too.
void SlabSweeps::build_graph() {
  const int slabs = slab_count_, gaps = slabs - 1, tasks = slabs + gaps;
  waits_.clear();
  places_.resize(kMostSweeps * tasks);
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    const int begin = sweep * tasks, before = begin - tasks;
    for (int slab = 0; slab < slabs; ++slab) {
      places_[begin + slab] = (slab + 0.5) / slabs;
      if (sweep == 0) continue;
      for (const int gap : {slab - 1, slab}) {
        if (gap >= 0 && gap < gaps) waits_.emplace_back(before + set_of_gap(gap), begin + slab);
      }
      if (gaps == 0) waits_.emplace_back(before, begin);
    }
    for (int gap = 0; gap < gaps; ++gap) {
      const int task = begin + set_of_gap(gap);
      places_[task] = (gap + 0.75) / slabs;
      waits_.emplace_back(begin + gap, task);
      waits_.emplace_back(begin + gap + 1, task);
      for (const int even : {gap - 1, gap + 1}) {
        if (gap % 2 == 1 && even < gaps) waits_.emplace_back(begin + set_of_gap(even), task);
      }
    }
  }
  graph_.build(kMostSweeps * tasks, waits_, places_);
}

// What two threads write stays apart in memory: velocities by slab, each body in a cache line of its own, and impulses
// by set.
void SlabSweeps::assign_places(const PreparedStep& step) {
  const int n = step.body_count();
  slab_first_.assign(slab_count_ + 1, 0);
  for (int body = 0; body < n; ++body) ++slab_first_[slab_of_body_[body] + 1];
  std::partial_sum(slab_first_.begin(), slab_first_.end(), slab_first_.begin());
  place_of_body_.resize(n);
  for (int body = 0; body < n; ++body) place_of_body_[body] = slab_first_[slab_of_body_[body]]++;
  velocity_.resize(static_cast<std::size_t>(kBodyStride) * (n + 1));
  place_of_group_.resize(groups_.size());
  int place = 0;
  for (int set = 0; set < set_count(); ++set) {
    for (int color = 0; color < color_count(set); ++color) {
      for (const int g : groups_of(set, color)) {
        place_of_group_[g] = place;
        place += step.groups()[g].row_count;
      }
    }
    place += kLineDoubles;
  }
  impulse_.resize(place);
}

double* SlabSweeps::velocities() {
  void* begin = velocity_.data();
  std::size_t space = velocity_.size() * sizeof(double);
  return static_cast<double*>(std::align(kLineDoubles * sizeof(double), sizeof(double), begin, space));
}

void SlabSweeps::run(int sweeps, std::span<double> impulse, std::span<double> v, ParallelTasks& tasks) {
  assert(sweeps <= kMostSweeps);
  const auto groups = step_->groups();
  const Arrays arrays{step_->problem(),
                      groups,
                      step_->mass_jacobian().data(),
                      inverse_diagonal_.data(),
                      place_of_body_.data(),
                      place_of_group_.data(),
                      impulse_.data(),
                      velocities()};
  for (std::size_t body = 0; body < place_of_body_.size(); ++body)
    std::copy_n(v.data() + 6 * body, 6, arrays.v + static_cast<long>(kBodyStride) * place_of_body_[body]);
  for (std::size_t g = 0; g < groups.size(); ++g)
    std::copy_n(impulse.data() + groups[g].first_row, groups[g].row_count,
                arrays.impulse + place_of_group_[g]);
  tasks.run(Stage::predict, graph_, [&](int task) {
    if (task / set_count() >= sweeps) return;
    check_stop(tasks.stop());
    const int set = task % set_count();
    for (int color = 0; color < color_count(set); ++color) visit(arrays, groups_of(set, color));
  });
  for (std::size_t body = 0; body < place_of_body_.size(); ++body)
    std::copy_n(arrays.v + static_cast<long>(kBodyStride) * place_of_body_[body], 6, v.data() + 6 * body);
  for (std::size_t g = 0; g < groups.size(); ++g)
    std::copy_n(arrays.impulse + place_of_group_[g], groups[g].row_count,
                impulse.data() + groups[g].first_row);
}

}  // namespace cleave
