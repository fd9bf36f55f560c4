#include "partition/degree_chooser.h"

namespace cleave {

Degree read_degree(const Settings& settings) {
  return {settings.word<DegreeUnit>(parameters::degree()),
          settings.word<DegreeScope>(parameters::degree_scope())};
}

DegreeChooser::DegreeChooser(const BodyGraph& graph, Order order, Degree degree)
    : sign_(order == Order::least ? 1 : -1),
      unit_(degree.unit == DegreeUnit::bodies ? EdgeWeight::pairs : EdgeWeight::constraints),
      scope_(degree.scope),
      key_(graph.body_count()),
      adjacent_to_(graph.body_count(), -1) {
  left_.reserve(graph.body_count());
  adjacent_.reserve(graph.body_count());
  for (int i = 0; i < graph.body_count(); ++i) {
    int degree = 0;
    for (int k = graph.first(i); k < graph.last(i); ++k) degree += graph.weight(k, unit_);
    key_[i] = sign_ * degree;
    left_.push(key_[i], i);
  }
}

int DegreeChooser::seed(const Growth& growth) {
  adjacent_.clear();
  return pop_true(growth, left_);
}

int DegreeChooser::next(const Growth& growth) { return pop_true(growth, adjacent_); }

void DegreeChooser::joined(const Growth& growth, int body) {
  for (int k = growth.graph.first(body); k < growth.graph.last(body); ++k) {
    const int other = growth.graph.neighbour(k);
    if (!growth.is_left(other)) continue;
    const bool degree_falls = scope_ == DegreeScope::left;
    if (degree_falls) {
      key_[other] -= sign_ * growth.graph.weight(k, unit_);
      left_.push(key_[other], other);
    }
    if (!degree_falls && adjacent_to_[other] == growth.open_part()) continue;
    adjacent_to_[other] = growth.open_part();
    adjacent_.push(key_[other], other);
  }
}

// Skips bodies that joined a part and entries from before a degree fell.
int DegreeChooser::pop_true(const Growth& growth, BodyHeap& heap) const {
  while (!heap.empty()) {
    const BodyHeap::Entry entry = heap.pop();
    if (growth.is_left(entry.body) && entry.key == key_[entry.body]) return entry.body;
  }
  return -1;
}

}  // namespace cleave
