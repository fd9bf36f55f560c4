#include "solver/cone_lanes.h"

#include "solver/linear/four_lanes.h"

namespace cleave {
namespace {

// For choices lane by lane, which Eigen makes one after the other.
FourLanes vector_of(const Lanes& lanes) { return read<FourLanes>(lanes.data()); }

Lanes lanes_of(const FourLanes& vector) {
  Lanes lanes;
  write(vector, lanes.data());
  return lanes;
}
static_assert(sizeof(FourLanes) == sizeof(Lanes));

// A row of [X sqrt(C)] and of the unit matrix beside it, on which the same is done.
struct ExtendedRow {
  FourLanes y[6] = {}, unit[3] = {};

  FourLanes dot(const ExtendedRow& other) const {
    FourLanes sum = y[0] * other.y[0];
    for (int i = 1; i < 6; ++i) sum += y[i] * other.y[i];
    return sum;
  }
  void subtract(const FourLanes& share, const ExtendedRow& other) {
    for (int i = 0; i < 6; ++i) y[i] -= share * other.y[i];
    for (int i = 0; i < 3; ++i) unit[i] -= share * other.unit[i];
  }
};

// Swaps in those lanes in which the second is the longer one.
void longer_first(ExtendedRow& first, ExtendedRow& second) {
  const auto is_longer = second.dot(second) > first.dot(first);
  const auto sort = [&](FourLanes& a, FourLanes& b) {
    const FourLanes former = a;
    a = is_longer ? b : a;
    b = is_longer ? former : b;
  };
  for (int i = 0; i < 6; ++i) sort(first.y[i], second.y[i]);
  for (int i = 0; i < 3; ++i) sort(first.unit[i], second.unit[i]);
}

}  // namespace

LaneWeights find_weight_basis(const LaneMatrix& x, const LaneVector& compliance) {
  ExtendedRow rows[3];
  for (int k = 0; k < 3; ++k) {
    const LaneVector& row = x.row[k];
    rows[k].y[0] = vector_of(row.n), rows[k].y[1] = vector_of(row.u), rows[k].y[2] = vector_of(row.v);
    rows[k].unit[k] = FourLanes{} + 1.0;
  }
  rows[0].y[3] = vector_of(compliance.n.sqrt());
  rows[1].y[4] = vector_of(compliance.u.sqrt());
  rows[2].y[5] = vector_of(compliance.v.sqrt());
  FourLanes d[3];
  for (int k = 0; k < 3; ++k) {
    for (int i = k + 1; i < 3; ++i) longer_first(rows[k], rows[i]);
    d[k] = rows[k].dot(rows[k]);
    for (int i = k + 1; i < 3; ++i) rows[i].subtract(rows[i].dot(rows[k]) / d[k], rows[k]);
  }
  LaneWeights weights;
  weights.inverse = {lanes_of(d[0]), lanes_of(d[1]), lanes_of(d[2])};
  for (int k = 0; k < 3; ++k) {
    const FourLanes* unit = rows[k].unit;
    weights.basis.row[k] = {lanes_of(unit[0]), lanes_of(unit[1]), lanes_of(unit[2])};
  }
  return weights;
}

// Comparisons with what is no number are false, and then all three entries are none.
Lanes largest_cone_residual(const Lanes& mu, const Lanes& d, const LaneVector& impulse, const LaneVector& w) {
  const LaneVector force = d * impulse, y = force - w;
  const Lanes t = tangential(y), apart = (t - mu * y.n) / (1 + mu * mu);
  const auto is_inside = vector_of(t) <= vector_of(mu * y.n);
  const auto is_zero = vector_of(mu * t) <= vector_of(-y.n);
  const auto size = [&](const Lanes& on_surface, const Lanes& beyond, const Lanes& within) {
    return is_inside ? vector_of(within.abs())
                     : (is_zero ? vector_of(beyond.abs()) : vector_of(on_surface.abs()));
  };
  const FourLanes n = size(w.n - mu * apart, force.n, w.n);
  const FourLanes u = size(w.u + apart * y.u / t, force.u, w.u);
  const FourLanes v = size(w.v + apart * y.v / t, force.v, w.v);
  const FourLanes larger = n > u ? n : u;
  return lanes_of(larger > v ? larger : v);
}

}  // namespace cleave
