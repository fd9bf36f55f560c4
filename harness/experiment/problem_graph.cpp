#include "harness/experiment/problem_graph.h"

#include <vector>

namespace cleave {

BodyGraph body_graph_of(const StepProblem& problem, std::optional<int> step, const KnownBodies& known) {
  std::vector<double> mass_kg(problem.body_count());
  for (int i = 0; i < problem.body_count(); ++i) mass_kg[i] = problem.mass[36 * i];

  std::vector<ConstraintLink> links;
  for (int r = 0; r < problem.row_count(); ++r) {
    if (r == 0 || problem.row_constraint[r] != problem.row_constraint[r - 1])
      links.push_back({problem.row_body[2 * r], problem.row_body[2 * r + 1], 0});
    ++links.back().rows;
  }
  BodyGraph graph(mass_kg, links, step, known.position_m);
  graph.set_groups(known.group);
  return graph;
}

}  // namespace cleave
