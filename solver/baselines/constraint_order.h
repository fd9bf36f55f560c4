// The order in which sweeps visit constraints (joints, contact points; the rows of one stay together and in
// their order):
//
//     natural        as the problem numbers them
//     random         every order is equally likely, another one in every sweep
//     height         the lowest contact_point (third coordinate, z is up) first
//     propagation    as contact spreads from what stands still and from joints, level after level: level 0
//                    are joints and constraints with a body that stands still, level k + 1 those with a body
//                    of a constraint of level k; what nothing reaches comes last
//
// Ties keep their natural order. Sources: Poulsen, Niebe and Erleben, Heuristic convergence rate improvements
// of the projected Gauss-Seidel method for frictional contact problems, WSCG 2010, section 4; Andrews,
// Erleben, Kry and Teichmann, Constraint reordering for iterative multi-body simulation with contact, ECCOMAS
// Multibody Dynamics 2017.
#pragma once

#include <span>
#include <vector>

#include "harness/base/dice.h"
#include "solver/prepared_step.h"

namespace cleave {

enum class OrderKind { natural, random, height, propagation };  // as the words of the parameter `order`

class ConstraintOrder {
 public:
  // seed: of the dice of random.
  ConstraintOrder(OrderKind kind, int seed) : kind_(kind), seed_(seed), dice_(seed) {}

  // Depends on the problem, kind and seed alone; buffers are kept.
  void begin(const PreparedStep& step);
  // Constraints of the next sweep, or in natural order all of a pair of bodies as one. Valid until the next
  // call.
  std::span<const RowGroup> next(const PreparedStep& step);

 private:
  void list_constraints(const PreparedStep& step);
  void measure_levels(const PreparedStep& step);
  void reach(int constraint, int level);
  void sort(const PreparedStep& step);

  OrderKind kind_;
  int seed_;
  Dice dice_;
  std::vector<RowGroup> constraints_;
  // Scratch.
  std::vector<RowGroup> unsorted_;
  std::vector<int> first_of_group_;  // constraints of each group, in constraints_ before they are sorted
  std::vector<int> order_, level_, level_of_body_, reached_;
};

}  // namespace cleave
