// What a problem file holds, once: reader and writer both walk these lists. See PROBLEM_FILES.md.
//
// A visitor is called with a name, a member and, for arrays, the shape, and whether a file must have it.
#pragma once

#include "harness/files/hdf5_types.h"
#include "harness/files/problem_file.h"

namespace cleave {

// optional: provenance, or told by the other arrays (problem_file_defaults.h).
enum class Presence { required, optional };

// The second has contact_set, the first has not: a file is of the first that holds it.
inline const std::string kProblemSchema = "cleave-problem-1";
inline const std::string kProblemSchemaWithSets = "cleave-problem-2";

inline const std::string& problem_schema(const StepProblem& problem) {
  return problem.contact_set.empty() ? kProblemSchema : kProblemSchemaWithSets;
}

// File: ProblemFile or const ProblemFile, and so on below.
template <class File, class Visitor>
void visit_attributes(File& file, Visitor&& visit) {
  using enum Presence;
  visit("scene", file.scene, optional);
  visit("step", file.step, optional);
  visit("h_s", file.problem.h_s, required);
  visit("seed", file.seed, optional);
  visit("friction_model", file.friction_model, optional);
  visit("erp", file.erp, optional);
  visit("cfm", file.cfm, optional);
}

// n bodies, m rows.
template <class File, class Visitor>
void visit_arrays(File& file, std::size_t n, std::size_t m, Visitor&& visit) {
  using enum Presence;
  auto& problem = file.problem;
  visit("mass", problem.mass, Hdf5Shape{n, 6, 6}, required);
  visit("free_velocity", problem.free_velocity, Hdf5Shape{n, 6}, required);
  visit("row_body", problem.row_body, Hdf5Shape{m, 2}, required);
  visit("jacobian", problem.jacobian, Hdf5Shape{m, 12}, required);
  visit("rhs", problem.rhs, Hdf5Shape{m}, required);
  visit("compliance", problem.compliance, Hdf5Shape{m}, required);
  visit("lower", problem.lower, Hdf5Shape{m}, required);
  visit("upper", problem.upper, Hdf5Shape{m}, required);
  visit("row_kind", problem.row_kind, Hdf5Shape{m}, optional);
  visit("friction_row", problem.friction_row, Hdf5Shape{m}, optional);
  visit("friction_coefficient", problem.friction_coefficient, Hdf5Shape{m}, optional);
  visit("row_constraint", problem.row_constraint, Hdf5Shape{m}, optional);
  visit("contact_point", problem.contact_point, Hdf5Shape{m, 3}, optional);
  visit("warm_impulse", problem.warm_impulse, Hdf5Shape{m}, optional);
  visit("position", file.position, Hdf5Shape{n, 3}, optional);
  visit("orientation", file.orientation, Hdf5Shape{n, 4}, optional);
}

// g geoms, k corners.
template <class Shapes, class Visitor>
void visit_shape_arrays(Shapes& shapes, std::size_t g, std::size_t k, Visitor&& visit) {
  visit("geom_body", shapes.geom_body, Hdf5Shape{g});
  visit("geom_type", shapes.geom_type, Hdf5Shape{g});
  visit("geom_size", shapes.geom_size, Hdf5Shape{g, 3});
  visit("geom_position", shapes.geom_position, Hdf5Shape{g, 3});
  visit("geom_orientation", shapes.geom_orientation, Hdf5Shape{g, 4});
  visit("convex_points", shapes.convex_points, Hdf5Shape{k, 3});
  visit("convex_first", shapes.convex_first, Hdf5Shape{g + 1});
}

template <class Solution, class Visitor>
void visit_solution_attributes(Solution& solution, Visitor&& visit) {
  visit("solver", solution.solver);
  visit("strategy", solution.strategy);
  visit("kernel", solution.kernel);
  visit("partitioner", solution.partitioner);
  visit("refiner", solution.refiner);
  visit("residual_m_per_s", solution.residual_m_per_s);
}

template <class Partition, class Visitor>
void visit_partition_attributes(Partition& partition, Visitor&& visit) {
  visit("partitioner", partition.partitioner);
  visit("refiner", partition.refiner);
}

}  // namespace cleave
