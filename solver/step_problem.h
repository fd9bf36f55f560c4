// One time step as a mixed linear complementarity problem (MLCP), in plain arrays.
//
// Bodies i = 0..n-1 with world-frame 6x6 mass blocks M_i and velocities (linear m/s, angular rad/s); rows r =
// 0..m-1 with one 1x6 Jacobian block per body (the second is unused when that body is -1, static):
//
//     v = v0 + M^-1 J^T lambda                      velocity after the step
//     w = J v + C lambda - b                        row slack, m/s (rad/s for angular rows)
//     lo <= lambda <= hi,  w >= 0 where lambda = lo,  w <= 0 where lambda = hi,  w = 0 strictly between
//
// with h the step, v0 = u + h M^-1 (applied and gyroscopic forces) the free velocity, lambda impulses in N s
// (N m s), C = cfm / h and b = (erp / h) * position error (or bounce, capped push-out) as ODE defines them.
// C > 0 makes the solution unique; with C = 0 velocities are unique and impulses may not be.
//
// The set of impulses need not be a box along the rows: the box of a contact's two tangent rows t1, t2 may be
// turned by an angle in the tangent plane. Bounds and conditions of these rows then hold for
//
//     lambda' = (c lambda_t1 + s lambda_t2, -s lambda_t1 + c lambda_t2),   c = cos angle, s = sin angle,
//
// and w' made from w alike: lo <= lambda' <= hi and so on. It is the problem whose rows are J' = (c J_t1 + s
// J_t2, -s J_t1 + c J_t2) with b' made alike, in other coordinates. Only the interior point takes it.
//
// Nor need it be a box at all. With n the normal row of a contact, t its one or two tangent rows and mu their
// friction coefficient, the three sets of ContactSet are
//
//     box      lo <= lambda <= hi for every row, with bounds that were frozen before the solve
//     cone     |lambda_t| <= mu lambda_n,  mu |w_t| <= w_n,  lambda_n w_n + lambda_t . w_t = 0
//     coulomb  |lambda_t| <= mu lambda_n,  lambda_n >= 0 complementary to w_n >= 0, and where w_t is not zero
//              the friction lambda_t = -mu lambda_n w_t / |w_t|: the cone with w_n + mu |w_t| in the place of
//              w_n (de Saxce and Feng, Mathematical and Computer Modelling 28, 1998)
//
// The cone is a convex problem like the box; its price is that sliding contacts part at mu |w_t|. Coulomb's
// law has not that flaw, and is not convex: a solution need not be unique.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace cleave {

// The one limit of an exact answer, for the judge and everyone who aims at it: a residual of at most this
// times max(1, largest |v0| entry), m/s.
inline constexpr double kExactLimit = 1e-9;

enum class RowKind : std::uint8_t { bilateral = 0, normal = 1, friction = 2 };
enum class ContactSet : std::uint8_t { box = 0, cone = 1, coulomb = 2 };

struct StepProblem {
  double h_s = 0;
  std::vector<double> mass;                  // (n, 6, 6) row-major, kg and kg m^2
  std::vector<double> free_velocity;         // (n, 6)
  std::vector<int> row_body;                 // (m, 2); the first is never -1, the second may be
  std::vector<double> jacobian;              // (m, 12): block of row_body[0], then of row_body[1]
  std::vector<double> rhs;                   // (m) b, m/s
  std::vector<double> compliance;            // (m) C = cfm / h, >= 0
  std::vector<double> lower;                 // (m) lo, N s; -infinity allowed
  std::vector<double> upper;                 // (m) hi, N s; +infinity allowed
  std::vector<RowKind> row_kind;             // (m)
  std::vector<int> friction_row;             // (m) index of the normal row a friction row belongs to, else -1
  std::vector<double> friction_coefficient;  // (m) mu of a friction row, else 0
  std::vector<int>
      row_constraint;  // (m) id of the joint or contact point; rows of one constraint are adjacent
  std::vector<double> contact_point;  // (m, 3) world position the row acts at, m
  std::vector<double> warm_impulse;   // (m) impulses carried over from the previous step, N s
  // (m), or empty where no box is turned: on a normal row, the angle of the box of the two friction rows that
  // follow it and have its bodies and one compliance; 0 on all other rows.
  std::vector<double> box_angle_rad;
  // (m), or empty where every contact has a box: on a normal row, the set of its impulse and those of the one
  // or two friction rows that follow it and have its bodies and one friction coefficient > 0; box on all
  // other rows. Where it is no box, the bounds are (0, infinity) on the normal row and (-infinity, infinity)
  // on the friction rows, and nothing is turned.
  std::vector<ContactSet> contact_set;

  int body_count() const { return static_cast<int>(free_velocity.size() / 6); }
  int row_count() const { return static_cast<int>(rhs.size()); }
};

// Empty when the arrays are consistent, else one line that names the array, the index, the value and what is
// allowed: shapes, finite numbers, body ids in range, lo <= hi, C >= 0, positive definite mass blocks, arrays
// that speak of the same row, contact or constraint in agreement.
std::string find_problem_error(const StepProblem& problem);

}  // namespace cleave
