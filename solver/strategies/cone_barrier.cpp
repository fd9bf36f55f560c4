#include "solver/strategies/cone_barrier.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// sqrt(x_n^2 - |x_t|^2), without the difference of two squares.
double hyperbolic_norm(const Vector3d& x) {
  const double t = tangential(x);
  return std::sqrt(std::max((x[0] - t) * (x[0] + t), 0.0));
}

double hyperbolic_product(const Vector3d& x, const Vector3d& y) {
  return x[0] * y[0] - x[1] * y[1] - x[2] * y[2];
}

Vector3d jordan_product(const Vector3d& x, const Vector3d& y) {
  return {x.dot(y), x[0] * y[1] + y[0] * x[1], x[0] * y[2] + y[0] * x[2]};
}

// q of l o q = c.
Vector3d jordan_divide(const Vector3d& c, const Vector3d& l) {
  const double norm = hyperbolic_norm(l);
  const double normal = hyperbolic_product(l, c) / (norm * norm);
  return {normal, (c[1] - normal * l[1]) / l[0], (c[2] - normal * l[2]) / l[0]};
}

// The inverse of the step along y at which l + step y leaves Q; 0 or less where it never does. It is the least eigenvalue of
// y in the coordinates where l is e.
double inverse_step(const Vector3d& l, const Vector3d& y) {
  const double norm = hyperbolic_norm(l);
  const Vector3d unit = l / norm;
  const double along = hyperbolic_product(unit, y);
  const double share = (along + y[0]) / (unit[0] + 1);
  return (tangential(y - share * unit) - along) / norm;
}

// c <- c + what brings the eigenvalues of a product within [low, high], by no more than -high downwards.
void aim_back(const Vector3d& product, double low, double high, Vector3d& c) {
  const double t = tangential(product);
  const auto change = [&](double eigenvalue) {
    if (eigenvalue < low) return low - eigenvalue;
    return eigenvalue > high ? std::max(high - eigenvalue, -high) : 0.0;
  };
  const double rise = change(product[0] + t), fall = change(product[0] - t);
  c[0] += (rise + fall) / 2;
  if (t == 0) return;
  for (int k = 1; k < 3; ++k) c[k] += (rise - fall) / 2 * product[k] / t;
}

struct Scaling {
  Matrix3d v, v_inverse;
};

// The symmetric V with V z = V^-1 s, of s and z inside Q.
Scaling find_scaling(const Vector3d& s, const Vector3d& z) {
  const double s_norm = hyperbolic_norm(s), z_norm = hyperbolic_norm(z);
  const Vector3d s_unit = s / s_norm, z_unit = z / z_norm;
  const double half = std::sqrt((1 + s_unit.dot(z_unit)) / 2);
  const double a = (s_unit[0] + z_unit[0]) / (2 * half);
  const double b = (s_unit[1] - z_unit[1]) / (2 * half), c = (s_unit[2] - z_unit[2]) / (2 * half);
  const double eta = std::sqrt(s_norm / z_norm);
  Scaling scaling;
  scaling.v << a, b, c, b, 1 + b * b / (1 + a), b * c / (1 + a), c, b * c / (1 + a), 1 + c * c / (1 + a);
  scaling.v_inverse = scaling.v / eta;
  scaling.v *= eta;
  for (int k = 1; k < 3; ++k) {
    scaling.v_inverse(0, k) = -scaling.v_inverse(0, k);
    scaling.v_inverse(k, 0) = -scaling.v_inverse(k, 0);
  }
  return scaling;
}

Vector3d to_second_order(const FrictionCone& cone, Vector3d impulse) {
  impulse[0] *= cone.mu;
  return impulse;
}

Vector3d inside(Vector3d x, double margin) {
  x[0] = std::max(x[0], tangential(x) + margin);
  return x;
}

}  // namespace

void find_weight_basis(const Matrix3d& x, std::span<const double> compliance, std::span<double> basis,
                       std::span<double> d) {
  const int n = static_cast<int>(compliance.size());
  Eigen::Matrix<double, 3, 6, Eigen::RowMajor> y = Eigen::Matrix<double, 3, 6, Eigen::RowMajor>::Zero();
  y.leftCols<3>() = x;
  for (int k = 0; k < n; ++k) y(k, 3 + k) = std::sqrt(compliance[k]);
  Matrix3d rows = Matrix3d::Identity();  // y now = rows times y as it was
  std::array<int, 3> order = {0, 1, 2};
  for (int k = 0; k < n; ++k) {
    for (int i = k + 1; i < n; ++i) {
      if (y.row(order[i]).squaredNorm() > y.row(order[k]).squaredNorm()) std::swap(order[i], order[k]);
    }
    const int pivot = order[k];
    d[k] = y.row(pivot).squaredNorm();
    for (int i = k + 1; i < n; ++i) {
      const double share = y.row(order[i]).dot(y.row(pivot)) / d[k];
      y.row(order[i]) -= share * y.row(pivot);
      rows.row(order[i]) -= share * rows.row(pivot);
    }
  }
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < n; ++i) basis[n * k + i] = rows(order[k], i);
  }
}

// task(cone, k) for every cone, in the ranges of their normal rows.
template <class Task>
void ConeBarrier::run_over_cones(SolveState& state, const Task& task) const {
  if (point_.empty()) return;
  const std::span<const FrictionCone> cones = state.step->set().cones();
  state.run_over_rows([&](int, int, int range) {
    for (int k = cone_first_[range]; k < cone_first_[range + 1]; ++k) task(cones[k], k, range);
  });
}

void ConeBarrier::start(SolveState& state, std::span<const double> speed) {
  const std::span<const FrictionCone> cones = state.step->set().cones();
  cone_first_.assign(state.range_count() + 1, static_cast<int>(cones.size()));
  for (int range = 0; range < state.range_count(); ++range) {
    cone_first_[range] = static_cast<int>(
        std::ranges::lower_bound(cones, range * state.rows_of_a_range(), {}, &FrictionCone::first_row) -
        cones.begin());
  }
  point_.resize(cones.size());
  scaled_gap_.resize(cones.size());
  compliance_.resize(cones.size());
  now_.resize(cones.size());
  run_over_cones(state, [&](const FrictionCone& cone, int k, int) {
    const double least = speed[cone.first_row], d = state.step->diagonal()[cone.first_row];
    Point& point = point_[k];
    point.s = inside(to_second_order(cone, cone.load(state.impulse)), least / d);
    Vector3d z = cone.load(state.slack);
    z[0] /= cone.mu;
    point.z = inside(z, least);
    const Scaling scaling = find_scaling(point.s, point.z);
    point.w = scaling.v;
    point.w_inverse = scaling.v_inverse;
    point.l = point.w * point.z;
  });
}

void ConeBarrier::weigh(SolveState& state, std::span<double> inverse_weight) {
  const std::span<WeightBlock> blocks = state.cone_blocks();
  run_over_cones(state, [&](const FrictionCone& cone, int k, int) {
    const Point& point = point_[k];
    scaled_gap_[k] =
        point.w_inverse.transpose() * (to_second_order(cone, cone.load(state.impulse)) - point.s);
    Matrix3d x = point.w_inverse;
    x.row(0) *= cone.mu;
    compliance_[k] = cone.load(inverse_weight);
    const std::span<const double> compliance(compliance_[k].data(), cone.row_count);
    find_weight_basis(x, compliance, blocks[k].basis, inverse_weight.subspan(cone.first_row, cone.row_count));
  });
}

void ConeBarrier::aim(SolveState& state, double product, bool second_order) {
  run_over_cones(state, [&](const FrictionCone&, int k, int) {
    const Vector3d& l = point_[k].l;
    Direction& now = now_[k];
    now.c = -jordan_product(l, l);
    now.c[0] += product;
    if (second_order) now.c -= jordan_product(now.ds, now.dz);
    now.q = jordan_divide(now.c, l);
  });
}

void ConeBarrier::add_to_right_hand_side(SolveState& state) const {
  run_over_cones(state, [&](const FrictionCone& cone, int k, int) {
    const Vector3d scaled = point_[k].l + now_[k].q - scaled_gap_[k];
    const Vector3d of_rows = to_second_order(cone, point_[k].w_inverse * scaled);
    cone.store(cone.load(state.f_r) + of_rows, state.f_r);
  });
}

BarrierCourse ConeBarrier::follow(SolveState& state) {
  courses_.assign(state.range_count(), BarrierCourse{});
  run_over_cones(state, [&](const FrictionCone& cone, int k, int range) {
    const Point& point = point_[k];
    Direction& now = now_[k];
    now.ds = point.w_inverse.transpose() * to_second_order(cone, cone.load(state.dlambda)) + scaled_gap_[k];
    now.dz = now.q - now.ds;
    BarrierCourse& course = courses_[range];
    course.largest_step =
        std::max({course.largest_step, inverse_step(point.l, now.ds), inverse_step(point.l, now.dz)});
    course.product[0] += point.l.squaredNorm();
    course.product[1] += point.l.dot(now.q);
    course.product[2] += now.ds.dot(now.dz);
  });
  return join_courses(courses_);
}

// There w = S (z + dz), as the direction solves the equation in w.
void ConeBarrier::predict_shift(SolveState& state, std::span<double> shift) const {
  run_over_cones(state, [&](const FrictionCone& cone, int k, int) {
    const Vector3d z = point_[k].w_inverse * (point_[k].l + now_[k].dz);
    shift[k] = cone.coulomb ? cone.mu * tangential(z) : 0.0;
  });
}

void ConeBarrier::correct(SolveState& state, double trial, double low, double high) {
  before_ = now_;
  run_over_cones(state, [&](const FrictionCone&, int k, int) {
    const Vector3d& l = point_[k].l;
    Direction& now = now_[k];
    aim_back(jordan_product(l + trial * now.ds, l + trial * now.dz), low, high, now.c);
    now.q = jordan_divide(now.c, l);
  });
}

void ConeBarrier::advance(SolveState& state, double step) {
  run_over_cones(state, [&](const FrictionCone&, int k, int) {
    Point& point = point_[k];
    const Vector3d s = point.l + step * now_[k].ds, z = point.l + step * now_[k].dz;
    point.s = point.w.transpose() * s;
    point.z = point.w_inverse * z;
    const Scaling scaling = find_scaling(s, z);
    point.l = scaling.v * z;
    point.w = (scaling.v * point.w).eval();
    point.w_inverse = (point.w_inverse * scaling.v_inverse).eval();
  });
}

template <class Velocity>
double ConeBarrier::greatest(SolveState& state, const Velocity& velocity_of) {
  if (point_.empty()) return 0;
  worst_.assign(state.range_count(), 0.0);
  run_over_cones(state, [&](const FrictionCone& cone, int k, int range) {
    const Vector3d velocity = velocity_of(cone, k);
    const double largest = velocity.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>();
    if (!(largest <= worst_[range]))
      worst_[range] = std::isnan(largest) ? std::numeric_limits<double>::infinity() : largest;
  });
  return std::ranges::max(worst_);
}

double ConeBarrier::rounding(SolveState& state, std::span<const double> row_velocity) {
  return greatest(state, [&](const FrictionCone& cone, int k) -> Vector3d {
    const Vector3d dlambda = cone.load(state.dlambda);
    const Matrix3d& inverse = point_[k].w_inverse;
    const Vector3d scaled = inverse.transpose() * to_second_order(cone, dlambda);
    const Vector3d weighed = to_second_order(cone, inverse * scaled) + compliance_[k].cwiseProduct(dlambda);
    return cone.load(state.f_r) - cone.load(row_velocity) - weighed;
  });
}

}  // namespace cleave
