#include "solver/slab_sweeps.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "solver/counting_sort.h"

namespace cleave {
namespace {

constexpr int kSlabRows = 600;   // about so many in a slab: five microseconds of work
constexpr int kWordColors = 64;  // colours in one word of used_colors_
constexpr double kLastPlace = 1 - 1e-9;

signed char side_of(const SlabRow& row, float impulse) {
  return static_cast<signed char>(impulse <= row.lower() ? -1 : impulse >= row.upper() ? 1 : 0);
}

}  // namespace

void SlabSweeps::bind(const PreparedStep& step, ParallelTasks& tasks) {
  assert(step.set().axes().empty());
  step_ = &step;
  measure_distances(step);
  cut_slabs(step);
  color_groups(step);
  sort_groups(step, tasks);
  assign_places(step);
  tasks.run(set_count(), [&](int set) { pack_rows(step, set); });
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

void SlabSweeps::sort_groups(const PreparedStep& step, ParallelTasks& tasks) {
  const auto color = [this](int g) { return color_first_[set_of_group_[g]] + color_of_group_[g]; };
  sort_into_buckets(static_cast<int>(set_of_group_.size()), color_first_.back(), color, group_first_,
                    groups_);
  const auto rows = [&](int g) { return step.groups()[g].row_count; };
  tasks.run(set_count(), [&](int set) {
    for (int c = color_first_[set]; c < color_first_[set + 1]; ++c)
      std::sort(groups_.begin() + group_first_[c], groups_.begin() + group_first_[c + 1],
                [&](int a, int b) { return rows(a) != rows(b) ? rows(a) > rows(b) : a < b; });
  });
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
  places_.push_back(kLastPlace);
  graph_.build(kMostSweeps * tasks + 1, waits_, places_);
}

// What two threads write stays apart in memory: velocities by slab, each body in a cache line of its own, and rows by
// set, in the order in which they are visited.
void SlabSweeps::assign_places(const PreparedStep& step) {
  const int n = step.body_count();
  sort_into_buckets(
      n, slab_count_, [this](int body) { return slab_of_body_[body]; }, slab_first_, queue_);
  place_of_body_.resize(n);
  for (int place = 0; place < n; ++place) place_of_body_[queue_[place]] = place;
  bodies_.resize(n + 1);
  bodies_[n] = {};
  place_of_group_.resize(groups_.size());
  int place = 0;
  for (const int g : groups_) {
    place_of_group_[g] = place;
    place += step.groups()[g].row_count;
  }
  rows_.resize(place);
  impulse_.resize(place);
  side_.resize(place);
  changed_.resize(set_count());
}

void SlabSweeps::pack_rows(const PreparedStep& step, int set) {
  const StepProblem& p = step.problem();
  const auto bound = [](double x) {
    constexpr double kMost = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(x, -kMost, kMost));
  };
  for (int i = group_first_[color_first_[set]]; i < group_first_[color_first_[set + 1]]; ++i) {
    const int g = groups_[i];
    const RowGroup& group = step.groups()[g];
    for (int k = 0; k < group.row_count; ++k) {
      const int r = group.first_row + k;
      SlabRow& row = rows_[place_of_group_[g] + k];
      row = {};
      const double inverse = kOverRelaxation / step.diagonal()[r];
      for (int c = 0; c < 6; ++c) {
        row.jacobian_a[c] = static_cast<float>(p.jacobian[12L * r + c] * inverse);
        row.jacobian_b[c] = static_cast<float>(p.jacobian[12L * r + 6 + c] * inverse);
        row.mass_jacobian_a[c] = static_cast<float>(step.mass_jacobian()[12L * r + c]);
        row.mass_jacobian_b[c] = static_cast<float>(step.mass_jacobian()[12L * r + 6 + c]);
      }
      row.kept() = static_cast<float>(1 - p.compliance[r] * inverse);
      row.push() = static_cast<float>(p.rhs[r] * inverse);
      row.lower() = bound(p.lower[r]);
      row.upper() = bound(p.upper[r]);
    }
  }
}

// for_body(body) of all bodies and for_group(g) of all groups.
template <class ForBody, class ForGroup>
void SlabSweeps::run_over_chunks(ParallelTasks& tasks, const ForBody& for_body,
                                 const ForGroup& for_group) const {
  const auto over = [](const auto& action) {
    return [&action](const Chunk& chunk) {
      for (int i = chunk.first; i < chunk.last; ++i) action(i);
    };
  };
  tasks.run_over(step_->body_chunks(), over(for_body), step_->group_chunks(), over(for_group));
}

void SlabSweeps::take_in(std::span<const double> impulse, std::span<const double> v, ParallelTasks& tasks) {
  const auto take_body = [&](int body) {
    SlabBody& own = bodies_[place_of_body_[body]];
    own = {};
    for (int c = 0; c < 6; ++c) own.velocity[c] = static_cast<float>(v[6 * body + c]);
  };
  const auto take_group = [&](int g) {
    const RowGroup& group = step_->groups()[g];
    for (int k = 0; k < group.row_count; ++k) {
      const int place = place_of_group_[g] + k;
      impulse_[place] = static_cast<float>(impulse[group.first_row + k]);
      side_[place] = side_of(rows_[place], impulse_[place]);
    }
  };
  run_over_chunks(tasks, take_body, take_group);
}

// What is at a bound there is at the bound here, to the last digit.
void SlabSweeps::give_out(std::span<double> impulse, std::span<double> v, ParallelTasks& tasks) const {
  const auto give_body = [&](int body) {
    const SlabBody& own = bodies_[place_of_body_[body]];
    for (int c = 0; c < 6; ++c) v[6 * body + c] = own.velocity[c];
  };
  const StepProblem& p = step_->problem();
  const auto give_group = [&](int g) {
    const RowGroup& group = step_->groups()[g];
    for (int k = 0; k < group.row_count; ++k) {
      const SlabRow& row = rows_[place_of_group_[g] + k];
      const float found = impulse_[place_of_group_[g] + k];
      const int r = group.first_row + k;
      impulse[r] = found <= row.lower()   ? p.lower[r]
                   : found >= row.upper() ? p.upper[r]
                                          : std::clamp<double>(found, p.lower[r], p.upper[r]);
    }
  };
  run_over_chunks(tasks, give_body, give_group);
}

// How many rows of the set changed sides.
int SlabSweeps::update_sides(int set) {
  const int first = group_first_[color_first_[set]], last = group_first_[color_first_[set + 1]];
  if (first == last) return 0;
  const int end = place_of_group_[groups_[last - 1]] + step_->groups()[groups_[last - 1]].row_count;
  int changed = 0;
  for (int place = place_of_group_[groups_[first]]; place < end; ++place) {
    const signed char side = side_of(rows_[place], impulse_[place]);
    changed += side != side_[place];
    side_[place] = side;
  }
  return changed;
}

int SlabSweeps::run(int sweeps, ParallelTasks& tasks, const std::function<void()>& beside) {
  assert(sweeps > 0 && sweeps <= kMostSweeps);
  const SlabArrays arrays{step_->groups(),
                          place_of_body_.data(),
                          place_of_group_.data(),
                          rows_.data(),
                          impulse_.data(),
                          bodies_.data(),
                          static_cast<int>(place_of_body_.size())};
  tasks.run(Stage::predict, graph_, [&](int task) {
    if (task == kMostSweeps * set_count()) return beside();
    const int sweep = task / set_count(), set = task % set_count();
    if (sweep >= sweeps) return;
    check_stop(tasks.stop());
    for (int color = 0; color < color_count(set); ++color) visit_groups(arrays, groups_of(set, color));
    if (sweep == sweeps - 1) changed_[set] = update_sides(set);
  });
  return std::accumulate(changed_.begin(), changed_.end(), 0);
}

}  // namespace cleave
