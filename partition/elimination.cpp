#include "partition/elimination.h"

#include <algorithm>

namespace cleave {

double column_flops(int below) {
  double sum = 0;
  for (int k = 1; k <= 6; ++k) sum += (6.0 * below + k) * (6.0 * below + k);
  return sum;
}

void Eliminator::find_neighbours(std::span<const int> bodies) {
  if (neighbours_.size() < bodies.size()) neighbours_.resize(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) local_of_body_[bodies[k]] = static_cast<int>(k);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    neighbours_[k].clear();
    for (const int other : graph_.neighbours(bodies[k]))
      if (local_of_body_[other] >= 0) neighbours_[k].push_back(local_of_body_[other]);
  }
  for (const int body : bodies) local_of_body_[body] = -1;
}

void Eliminator::push(int local) {
  queue_.push({stage_[local], static_cast<int>(neighbours_[local].size()), local});
}

void Eliminator::add_column(int local) {
  place_[local] = static_cast<int>(columns_.size());
  columns_.push_back({bodies_[local], static_cast<int>(neighbours_[local].size()), -1});
}

void Eliminator::eliminate(int local) {
  add_column(local);
  for (const int other : neighbours_[local]) {
    std::vector<int>& list = neighbours_[other];
    std::erase(list, local);
    ++stamp_;
    mark_[other] = stamp_;
    for (const int known : list) mark_[known] = stamp_;
    for (const int added : neighbours_[local])
      if (mark_[added] != stamp_) list.push_back(added);
    push(other);
  }
}

// What is left are neighbours of each other: they go by place, and each column reaches all that follow.
void Eliminator::eliminate_clique(std::span<const int> bodies) {
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (place_[k] >= 0) continue;
    add_column(static_cast<int>(k));
    columns_.back().below = static_cast<int>(bodies.size() - columns_.size());
    std::erase_if(neighbours_[k], [&](int other) { return place_[other] >= 0; });
  }
}

void Eliminator::find_parents() {
  for (std::size_t local = 0; local < bodies_.size(); ++local) {
    int& parent = columns_[place_[local]].parent;
    for (const int other : neighbours_[local])
      if (parent < 0 || place_[other] < parent) parent = place_[other];
  }
}

std::span<const EliminatedColumn> Eliminator::run(std::span<const int> bodies,
                                                  std::span<const int> stage_of_body) {
  const std::size_t count = bodies.size();
  bodies_.assign(bodies.begin(), bodies.end());
  find_neighbours(bodies);
  place_.assign(count, -1);
  mark_.assign(count, 0);
  stamp_ = 0;
  columns_.clear();
  stage_.assign(count, 0);
  if (!stage_of_body.empty())
    for (std::size_t k = 0; k < count; ++k) stage_[k] = stage_of_body[bodies[k]];
  const int last_stage = count == 0 ? 0 : std::ranges::max(stage_);
  for (std::size_t k = 0; k < count; ++k) push(static_cast<int>(k));
  while (columns_.size() < count) {
    const Candidate next = queue_.top();
    queue_.pop();
    if (place_[next.local] >= 0 || next.degree != static_cast<int>(neighbours_[next.local].size())) continue;
    if (next.stage == last_stage && next.degree == static_cast<int>(count - columns_.size()) - 1) {
      eliminate_clique(bodies);
      break;
    }
    eliminate(next.local);
  }
  queue_ = {};
  find_parents();
  return columns_;
}

}  // namespace cleave
