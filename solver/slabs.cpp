#include "solver/slabs.h"

#include <algorithm>

namespace cleave {
namespace {

constexpr int kSlabRows = 900;  // about so many in a slab: three microseconds of work

}  // namespace

void Slabs::cut(const PreparedStep& step, int sweeps) {
  measure_distances(step);
  cut_at_distances(step);
  build_graph(sweeps);
}

// Breadth first; appends to queue_ the bodies that are reached and have no distance yet. Returns the last of
// them.
int Slabs::walk_from(const PreparedStep& step, int start, int distance) {
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

// From a body at the edge: the one that is reached last from the body of lowest number. Islands follow each
// other.
void Slabs::measure_distances(const PreparedStep& step) {
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
void Slabs::cut_at_distances(const PreparedStep& step) {
  const int most = queue_.empty() ? 0 : distance_[queue_.back()];
  rows_at_.assign(most + 1, 0);
  for (const RowGroup& g : step.groups()) rows_at_[distance_[g.body_a]] += g.row_count;
  const int wanted = std::max(1, step.row_count() / kSlabRows);
  count_ = 0;
  long rows = 0;  // so far
  for (int at = 0; at <= most; ++at) {
    rows += rows_at_[at];
    rows_at_[at] = count_;
    if (rows * wanted >= static_cast<long>(count_ + 1) * step.row_count()) ++count_;
  }
  count_ = std::max(count_, 1);
  slab_of_body_.resize(step.body_count());
  for (int body = 0; body < step.body_count(); ++body)
    slab_of_body_[body] = std::min(rows_at_[distance_[body]], count_ - 1);
}

int Slabs::set_of(const RowGroup& group) const {
  const int a = slab_of_body_[group.body_a], b = group.body_b < 0 ? a : slab_of_body_[group.body_b];
  return a == b ? a : set_of_gap(std::min(a, b));
}

int Slabs::set_of_gap(int gap) const {
  const int even_gaps = count_ / 2;
  return count_ + (gap % 2 == 0 ? 0 : even_gaps) + gap / 2;
}

// A gap waits for the two insides, and one behind an odd slab for the gaps around it too.
void Slabs::wait_for_neighbours(int begin, int gap) {
  const int task = begin + set_of_gap(gap);
  waits_.emplace_back(begin + gap, task);
  waits_.emplace_back(begin + gap + 1, task);
  for (const int even : {gap - 1, gap + 1}) {
    if (gap % 2 == 1 && even < count_ - 1) waits_.emplace_back(begin + set_of_gap(even), task);
  }
}

// The end of a sweep waits for all sets, and the insides of the next one for it. The same graph serves all
// steps that are cut into as many slabs.
void Slabs::build_graph(int sweeps) {
  if (count_ == graph_count_ && sweeps == graph_sweeps_) return;
  const int gaps = count_ - 1;
  waits_.clear();
  places_.resize(sweeps * tasks_of_sweep());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const int begin = sweep * tasks_of_sweep(), end = begin + set_count();
    for (int slab = 0; slab < count_; ++slab) {
      places_[begin + slab] = (slab + 0.5) / count_;
      if (sweep > 0) waits_.emplace_back(begin - 1, begin + slab);
    }
    for (int gap = 0; gap < gaps; ++gap) {
      places_[begin + set_of_gap(gap)] = (gap + 0.75) / count_;
      wait_for_neighbours(begin, gap);
    }
    for (int task = begin; task < end; ++task) waits_.emplace_back(task, end);
    places_[end] = 0;
  }
  graph_sweeps_ = 0;  // until it is built: a solver that found no memory may be asked again
  graph_.build(sweeps * tasks_of_sweep(), waits_, places_);
  graph_count_ = count_;
  graph_sweeps_ = sweeps;
}

}  // namespace cleave
