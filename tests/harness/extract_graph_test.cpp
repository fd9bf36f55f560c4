// The body graph made from a problem's arrays alone.
#include <gtest/gtest.h>

#include "harness/experiment/problem_graph.h"

namespace cleave {
namespace {

// Three bodies of 1, 2 and 3 kg; rows given as (constraint, body a, body b).
StepProblem make_problem(std::initializer_list<std::array<int, 3>> rows) {
  StepProblem problem;
  problem.free_velocity.assign(18, 0);
  problem.mass.assign(108, 0);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 6; ++k) problem.mass[36 * i + 7 * k] = i + 1;
  for (const auto& [constraint, a, b] : rows) {
    problem.row_constraint.push_back(constraint);
    problem.row_body.insert(problem.row_body.end(), {a, b});
    problem.rhs.push_back(0);
  }
  return problem;
}

TEST(ProblemGraph, CountsConstraintsAndRowsOfEachPair) {
  // A joint of three rows, two contacts of two rows between the same pair turned round, one contact with the
  // ground.
  const BodyGraph graph = body_graph_of(make_problem(
      {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {4, 1, 2}, {4, 1, 2}, {5, 2, 1}, {5, 2, 1}, {6, 2, -1}}));
  ASSERT_EQ(graph.body_count(), 3);
  EXPECT_EQ(graph.edge_count(), 2);
  EXPECT_EQ(graph.mass_kg(2), 3);
  EXPECT_EQ(graph.degree(0), 1);
  EXPECT_EQ(graph.weight(graph.first(0), EdgeWeight::constraints), 1);
  EXPECT_EQ(graph.weight(graph.first(0), EdgeWeight::rows), 3);
  EXPECT_EQ(graph.neighbour(graph.first(2)), 1);
  EXPECT_EQ(graph.weight(graph.first(2), EdgeWeight::constraints), 2);
  EXPECT_EQ(graph.weight(graph.first(2), EdgeWeight::rows), 4);
}

TEST(ProblemGraph, StaticContactsAloneGiveNoEdge) {
  const BodyGraph graph = body_graph_of(make_problem({{0, 0, -1}, {1, 1, -1}, {2, 2, -1}}));
  EXPECT_EQ(graph.edge_count(), 0);
  EXPECT_EQ(body_graph_of(make_problem({})).body_count(), 3);
}

}  // namespace
}  // namespace cleave
