// What a problem file holds, once: reader and writer both walk these lists. See problem_file.h.
//
// A visitor is called with a name, a member and, for arrays, the shape.
#pragma once

#include "harness/files/hdf5_types.h"
#include "harness/files/problem_file.h"

namespace cleave {

inline const std::string kProblemSchema = "cleave-problem-1";

// File: ProblemFile or const ProblemFile, and so on below.
template <class File, class Visitor>
void visit_attributes(File& file, Visitor&& visit) {
  visit("scene", file.scene);
  visit("step", file.step);
  visit("h_s", file.problem.h_s);
  visit("seed", file.seed);
  visit("friction_model", file.friction_model);
  visit("erp", file.erp);
  visit("cfm", file.cfm);
}

// n bodies, m rows.
template <class File, class Visitor>
void visit_arrays(File& file, std::size_t n, std::size_t m, Visitor&& visit) {
  auto& problem = file.problem;
  visit("mass", problem.mass, Hdf5Shape{n, 6, 6});
  visit("free_velocity", problem.free_velocity, Hdf5Shape{n, 6});
  visit("row_body", problem.row_body, Hdf5Shape{m, 2});
  visit("jacobian", problem.jacobian, Hdf5Shape{m, 12});
  visit("rhs", problem.rhs, Hdf5Shape{m});
  visit("compliance", problem.compliance, Hdf5Shape{m});
  visit("lower", problem.lower, Hdf5Shape{m});
  visit("upper", problem.upper, Hdf5Shape{m});
  visit("row_kind", problem.row_kind, Hdf5Shape{m});
  visit("friction_row", problem.friction_row, Hdf5Shape{m});
  visit("friction_coefficient", problem.friction_coefficient, Hdf5Shape{m});
  visit("row_constraint", problem.row_constraint, Hdf5Shape{m});
  visit("contact_point", problem.contact_point, Hdf5Shape{m, 3});
  visit("warm_impulse", problem.warm_impulse, Hdf5Shape{m});
  visit("position", file.position, Hdf5Shape{n, 3});
  visit("orientation", file.orientation, Hdf5Shape{n, 4});
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
