// Four friction contacts side by side: vectors and matrices of a contact whose entries are a lane for each of
// the four, and the algebra of the second-order cone Q = { x: |x_t| <= x_n } on them, in vector instructions.
// What the compiler would call rather than inline is inlined by attribute: a call hands its vectors over in
// memory.
//
// With x o y = (x . y, x_n y_t + y_n x_t), e = (1, 0, 0) is the one, and x_n +- |x_t| are the eigenvalues of
// x. Source: Vandenberghe, "The CVXOPT linear and quadratic cone program solvers", 2010, section 4.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>

#include "solver/cone.h"

namespace cleave {

inline constexpr int kContactLanes = 4;
using Lanes = Eigen::Array<double, kContactLanes, 1>;

struct LaneVector {
  Lanes n = Lanes::Zero(), u = Lanes::Zero(), v = Lanes::Zero();  // along the normal and the two tangents
};

struct LaneMatrix {
  LaneVector row[3];
};

// Contacts in the lanes: the first four of a list or all there are. The other lanes are a contact of mu = 1
// whose numbers are zero.
class ContactLanes {
 public:
  explicit ContactLanes(std::span<const FrictionCone> cones)
      : cone(cones.data()), count(static_cast<int>(std::min<std::size_t>(cones.size(), kContactLanes))) {
    for (int lane = 0; lane < count; ++lane) {
      mu[lane] = cone[lane].mu;
      is_there[lane] = 1;
      second_tangent[lane] = cone[lane].row_count == 3 ? 1 : 0;
    }
  }

  // Of x (m). Vectors are put together in registers: read right after their entries were stored they would
  // wait for memory.
  LaneVector load(std::span<const double> x) const {
    const std::array<const double*, kContactLanes> row = rows(x);
    const auto entries = [&](int k) { return Lanes(row[0][k], row[1][k], row[2][k], row[3][k]); };
    const auto third = [&](int lane) { return has_third(lane) ? row[lane][2] : 0.0; };
    return {entries(0), entries(1), Lanes(third(0), third(1), third(2), third(3))};
  }
  void store(const LaneVector& lanes, std::span<double> x) const {
    for (int lane = 0; lane < count; ++lane) {
      double* row = x.data() + cone[lane].first_row;
      row[0] = lanes.n.data()[lane], row[1] = lanes.u.data()[lane];
      if (has_third(lane)) row[2] = lanes.v.data()[lane];
    }
  }
  // Of x (m) on the normals; one in the other lanes.
  Lanes load_normal(std::span<const double> x) const {
    const std::array<const double*, kContactLanes> row = rows(x);
    return Lanes(row[0][0], row[1][0], row[2][0], row[3][0]) + (1 - is_there);
  }

  const FrictionCone* cone;
  int count;
  Lanes mu = Lanes::Ones(), is_there = Lanes::Zero(), second_tangent = Lanes::Zero();

 private:
  static constexpr double kNothing[3] = {};
  std::array<const double*, kContactLanes> rows(std::span<const double> x) const {
    std::array<const double*, kContactLanes> row;
    for (int lane = 0; lane < kContactLanes; ++lane)
      row[lane] = lane < count ? x.data() + cone[lane].first_row : kNothing;
    return row;
  }
  bool has_third(int lane) const { return lane < count && cone[lane].row_count == 3; }
};

inline LaneVector operator+(const LaneVector& x, const LaneVector& y) {
  return {x.n + y.n, x.u + y.u, x.v + y.v};
}
inline LaneVector operator-(const LaneVector& x, const LaneVector& y) {
  return {x.n - y.n, x.u - y.u, x.v - y.v};
}
inline LaneVector operator*(const Lanes& a, const LaneVector& x) { return {a * x.n, a * x.u, a * x.v}; }
inline Lanes dot(const LaneVector& x, const LaneVector& y) { return x.n * y.n + x.u * y.u + x.v * y.v; }

inline LaneVector operator*(const LaneMatrix& a, const LaneVector& x) {
  return {dot(a.row[0], x), dot(a.row[1], x), dot(a.row[2], x)};
}
[[gnu::always_inline]] inline LaneVector transposed_times(const LaneMatrix& a, const LaneVector& x) {
  return x.n * a.row[0] + x.u * a.row[1] + x.v * a.row[2];
}
inline LaneMatrix operator*(const LaneMatrix& a, const LaneMatrix& b) {
  return {transposed_times(b, a.row[0]), transposed_times(b, a.row[1]), transposed_times(b, a.row[2])};
}

inline Lanes tangential(const LaneVector& x) { return (x.u * x.u + x.v * x.v).sqrt(); }

// sqrt(x_n^2 - |x_t|^2), without the difference of two squares.
inline Lanes hyperbolic_norm(const LaneVector& x) {
  const Lanes t = tangential(x);
  return ((x.n - t) * (x.n + t)).max(0.0).sqrt();
}

inline Lanes hyperbolic_product(const LaneVector& x, const LaneVector& y) {
  return x.n * y.n - x.u * y.u - x.v * y.v;
}

inline LaneVector jordan_product(const LaneVector& x, const LaneVector& y) {
  return {dot(x, y), x.n * y.u + y.n * x.u, x.n * y.v + y.n * x.v};
}

// A point inside Q with what divisions by it need.
struct LaneDivisor {
  LaneVector l, unit;  // unit = l / norm
  Lanes inverse_norm = Lanes::Ones();
};

inline LaneDivisor divisor(const LaneVector& l) {
  const Lanes inverse = hyperbolic_norm(l).inverse();
  return {l, inverse * l, inverse};
}

// q of l o q = c.
inline LaneVector jordan_divide(const LaneVector& c, const LaneDivisor& by) {
  const Lanes normal = hyperbolic_product(by.unit, c) * by.inverse_norm, inverse = by.l.n.inverse();
  return {normal, (c.u - normal * by.l.u) * inverse, (c.v - normal * by.l.v) * inverse};
}

// The inverse of the step along y at which l + step y leaves Q; 0 or less where it never does. It is minus
// the least eigenvalue of y in the coordinates where l is e.
[[gnu::always_inline]] inline Lanes inverse_step(const LaneDivisor& by, const LaneVector& y) {
  const Lanes along = hyperbolic_product(by.unit, y);
  const Lanes share = (along + y.n) / (by.unit.n + 1);
  return (tangential(y - share * by.unit) - along) * by.inverse_norm;
}

// What brings the eigenvalues of a product within [low, high], by no more than -high downwards.
inline LaneVector change_into_band(const LaneVector& product, double low, double high) {
  constexpr double kLeastTangent = 1e-300;  // a tangent of zero has no direction, and none is asked for
  const auto change = [&](const Lanes& eigenvalue) -> Lanes {
    return (low - eigenvalue).max(0.0) + (high - eigenvalue).min(0.0).max(-high);
  };
  const Lanes t = tangential(product);
  const Lanes rise = change(product.n + t), fall = change(product.n - t);
  const Lanes along = 0.5 * (rise - fall) / t.max(kLeastTangent);
  return {0.5 * (rise + fall), along * product.u, along * product.v};
}

// The symmetric V with V z = V^-1 s, of s and z inside Q.
struct LaneScaling {
  LaneMatrix v, v_inverse;
};

[[gnu::always_inline]] inline LaneScaling find_scaling(const LaneVector& s, const LaneVector& z) {
  const Lanes s_norm = hyperbolic_norm(s), z_norm = hyperbolic_norm(z);
  const LaneVector s_unit = s_norm.inverse() * s, z_unit = z_norm.inverse() * z;
  const Lanes twice_half = 2 * ((1 + dot(s_unit, z_unit)) / 2).sqrt();
  const Lanes a = (s_unit.n + z_unit.n) / twice_half;
  const Lanes b = (s_unit.u - z_unit.u) / twice_half, c = (s_unit.v - z_unit.v) / twice_half;
  const Lanes eta = (s_norm / z_norm).sqrt(), share = (1 + a).inverse();
  const Lanes uu = 1 + b * b * share, uv = b * c * share, vv = 1 + c * c * share;
  const auto rows = [&](const Lanes& scale, double sign) -> LaneMatrix {
    const Lanes nu = sign * scale * b, nv = sign * scale * c;
    return {{{scale * a, nu, nv}, {nu, scale * uu, scale * uv}, {nv, scale * uv, scale * vv}}};
  };
  return {rows(eta, 1), rows(eta.inverse(), -1)};
}

// D = B diag(1 / d) B^T of D^-1 = X X^T + diag(compliance), by elimination with the largest row first, so
// that what a soft direction weighs is not lost beside a stiff one. A contact with one tangent has zeros for
// the other.
struct LaneWeights {
  LaneMatrix basis;    // row k: column k of B
  LaneVector inverse;  // d
};

LaneWeights find_weight_basis(const LaneMatrix& x, const LaneVector& compliance);

// The largest entry of cone.h's cone_residual, m/s; no number where an impulse or a slack is none.
Lanes largest_cone_residual(const Lanes& mu, const Lanes& d, const LaneVector& impulse, const LaneVector& w);

}  // namespace cleave
