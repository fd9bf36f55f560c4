// Groups of rows that share no dynamic body within a colour (group_coloring.h), visited by projected
// Gauss-Seidel on several threads: colour after colour, those of one colour side by side. In whichever order
// threads come to them, bytes are the same. Fratarcangeli, Tibaldo, Pellacini: Vivace, ACM Transactions on
// Graphics 35(6), 2016, section 4.
#pragma once

#include <algorithm>
#include <span>

#include "harness/base/ceil_div.h"
#include "solver/gauss_seidel.h"
#include "solver/group_coloring.h"
#include "solver/parallel_tasks.h"
#include "solver/solution.h"

namespace cleave {

class ColoredGroups {
 public:
  // groups: stay with the caller, and as they are while there are sweeps.
  void color(int body_count, std::span<const RowGroup> groups) {
    groups_ = groups;
    coloring_.color(body_count, groups);
  }

  void color_by_chance(int body_count, std::span<const RowGroup> groups, std::uint64_t seed) {
    groups_ = groups;
    coloring_.color_by_chance(body_count, groups, seed);
  }

  // Every row of the groups once.
  void sweep(const PreparedStep& step, ParallelTasks& tasks, Solution& solution) {
    for (int color = 0; color < coloring_.color_count(); ++color) visit_color(step, color, tasks, solution);
  }

 private:
  static constexpr int kTaskGroups = 64;  // of one task: about 300 rows of a pile, some microseconds

  void visit_color(const PreparedStep& step, int color, ParallelTasks& tasks, Solution& solution) {
    const std::span<const int> members = coloring_.groups_of(color);
    const int count = static_cast<int>(members.size());
    tasks.run(ceil_div(count, kTaskGroups), [&](int task) {
      const int last = std::min(count, (task + 1) * kTaskGroups);
      for (int i = task * kTaskGroups; i < last; ++i)
        gauss_seidel_visit(step, groups_[members[i]], LaneSlack{}, WithinBounds(step), solution.impulse,
                           solution.velocity);
    });
  }

  std::span<const RowGroup> groups_;
  GroupColoring coloring_;
};

}  // namespace cleave
