// Which rows a friction cone has and what it is: the set of one contact, in the terms of the rows. What is
// done with it, and its definition, is in cone.h: to be included only where it is done, as Eigen's vectors
// take the compiler long.
#pragma once

namespace cleave {

struct FrictionCone {
  int first_row = 0;  // the normal; tangents follow
  int row_count = 3;  // 2 or 3
  double mu = 0;
  bool coulomb = false;  // whether w_n + mu |w_t| takes the place of w_n
};

}  // namespace cleave
