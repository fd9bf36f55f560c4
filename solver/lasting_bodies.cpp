#include "solver/lasting_bodies.h"

#include <algorithm>
#include <limits>

namespace cleave {
namespace {

constexpr char kMostNeighbours = 2, kTooMany = kMostNeighbours + 1;

bool has_bounds(const StepProblem& problem, const RowGroup& group) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (int row = group.first_row; row < group.first_row + group.row_count; ++row)
    if (problem.lower[row] != -kInfinity || problem.upper[row] != kInfinity) return true;
  return false;
}

// Of each body, or kTooMany where there are more than may be, or a row with bounds. Two groups of a pair
// count as two neighbours: that loses little.
void count_neighbours(const PreparedStep& step, std::vector<char>& count) {
  count.assign(step.body_count(), 0);
  for (const RowGroup& group : step.groups()) {
    const bool is_bounded = has_bounds(step.problem(), group);
    for (const int body : {group.body_a, group.body_b}) {
      if (body < 0) continue;
      if (is_bounded) count[body] = kTooMany;
      if (group.body_b >= 0 && count[body] < kTooMany) ++count[body];
    }
  }
}

}  // namespace

bool find_lasting_bodies(const PreparedStep& step, std::vector<char>& lasting) {
  count_neighbours(step, lasting);
  for (char& body : lasting) body = body > 0 && body <= kMostNeighbours ? 1 : 0;
  return std::ranges::find(lasting, 1) != lasting.end();
}

}  // namespace cleave
