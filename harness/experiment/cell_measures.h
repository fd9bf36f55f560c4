// Columns of steps.csv that are computed from a solved cell alone: one file and one row here
// (cell_measures.cpp) each. Header, manifest and rows follow. Give it a unit in its name; it stays "nan"
// where a solve left nothing to look at. Columns that need more (times, the world, options) are in
// step_record.h.
#pragma once

#include <span>

#include "partition/body_graph.h"
#include "solver/residual.h"
#include "solver/solution.h"
#include "solver/step_problem.h"

namespace cleave {

// What one combination made of a step.
struct Cell {
  const StepProblem& problem;
  const BodyGraph* graph;             // null for a solver that ignores parts
  std::span<const int> part_of_body;  // (n); empty for such a solver
  const Solution& solution;
  const ResidualReport& verdict;
};

struct CellMeasure {
  const char* name;  // of the column
  const char* help;  // one line
  double (*value)(const Cell& cell);
};

std::span<const CellMeasure> cell_measures();

}  // namespace cleave
