#include <algorithm>
#include <array>
#include <cmath>

#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

constexpr double kGravity_m_per_s2 = 9.81;

Vec3 subtract(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Velocity along a direction of the body's point at arm: [d, arm x d].
std::array<double, 6> point_block(const Vec3& direction, const Vec3& arm, double sign) {
  const Vec3 turn = cross(arm, direction);
  return {sign * direction[0], sign * direction[1], sign * direction[2],
          sign * turn[0],      sign * turn[1],      sign * turn[2]};
}

// Free velocity of a body in free fall with a little noise.
std::array<double, 6> falling(SeededRandom& random) {
  std::array<double, 6> velocity;
  for (double& entry : velocity) entry = random.uniform(-0.05, 0.05);
  velocity[2] -= kTestStep_s * kGravity_m_per_s2;
  return velocity;
}

class Structure {
 public:
  Structure(std::uint64_t seed, double cfm) : random(seed), compliance_(cfm / kTestStep_s) {
    problem.h_s = kTestStep_s;
  }

  int add_body(const Vec3& center, double mass_kg, const Vec3& inertia_kg_m2) {
    centers.push_back(center);
    return append_body(problem, mass_kg, inertia_kg_m2, falling(random));
  }

  // Row: relative velocity of the two bodies at a point along a direction.
  RowSpec point_row(int a, int b, const Vec3& point, const Vec3& direction, double error) const {
    RowSpec row;
    row.body_a = a;
    row.body_b = b;
    row.jacobian_a = point_block(direction, subtract(point, centers[a]), 1);
    if (b >= 0) row.jacobian_b = point_block(direction, subtract(point, centers[b]), -1);
    row.rhs = kTestErp / kTestStep_s * error;
    row.compliance = compliance_;
    row.point = point;
    row.constraint = constraints;
    return row;
  }

  void add_contact(int a, int b, const Vec3& point, const Vec3& normal, double mu, double load_kg) {
    RowSpec row = point_row(a, b, point, normal, random.uniform(0, 1e-3));
    row.kind = RowKind::normal;
    row.lower = 0;
    const int normal_row = append_row(problem, row);
    if (mu > 0) {
      const Vec3 axis = std::abs(normal[2]) > 0.7 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
      const Vec3 first = cross(normal, axis);
      const double share = random.chance(0.1) ? 0 : random.uniform(0, 1.5);
      const double bound = mu * share * load_kg * kGravity_m_per_s2 * kTestStep_s;
      for (const Vec3& tangent : {first, cross(normal, first)}) {
        RowSpec friction = point_row(a, b, point, tangent, 0);
        friction.kind = RowKind::friction;
        friction.lower = -bound;
        friction.upper = bound;
        friction.friction_row = normal_row;
        friction.friction_coefficient = mu;
        append_row(problem, friction);
      }
    }
    ++constraints;
  }

  void add_ball(int a, int b, const Vec3& anchor) {
    for (int k = 0; k < 3; ++k) {
      Vec3 direction{};
      direction[k] = 1;
      append_row(problem, point_row(a, b, anchor, direction, random.uniform(-1e-4, 1e-4)));
    }
    ++constraints;
  }

  // Ball joint plus two rows that keep the axes along z.
  void add_hinge(int a, int b, const Vec3& anchor) {
    add_ball(a, b, anchor);
    --constraints;
    for (int k = 3; k < 5; ++k) {
      RowSpec row = point_row(a, b, anchor, Vec3{}, 0);
      row.jacobian_a[k] = 1;
      if (b >= 0) row.jacobian_b[k] = -1;
      append_row(problem, row);
    }
    ++constraints;
  }

  StepProblem problem;
  SeededRandom random;
  std::vector<Vec3> centers;
  int constraints = 0;

 private:
  double compliance_ = 0;
};

struct Rectangle {
  std::array<double, 2> least, most;
  bool empty() const { return most[0] - least[0] < 1e-6 || most[1] - least[1] < 1e-6; }
};

// Where two unit squares around the centers overlap, in the two axes given.
Rectangle overlap(const Vec3& a, const Vec3& b, int axis_0, int axis_1) {
  Rectangle result{};
  const std::array<int, 2> axes = {axis_0, axis_1};
  for (int k = 0; k < 2; ++k) {
    result.least[k] = std::max(a[axes[k]], b[axes[k]]) - 0.5;
    result.most[k] = std::min(a[axes[k]], b[axes[k]]) + 0.5;
  }
  return result;
}

// Four contacts at the corners of the common face of a and the block below (or beside) it along an axis.
void add_face(Structure& pile, int a, int b, const Vec3& center_b, int axis, const PileOptions& options,
              double load_kg) {
  const int axis_0 = (axis + 1) % 3;
  const int axis_1 = (axis + 2) % 3;
  const Rectangle face = overlap(pile.centers[a], center_b, axis_0, axis_1);
  if (face.empty()) return;
  Vec3 normal{};
  normal[axis] = 1;
  for (int corner = 0; corner < 4; ++corner) {
    Vec3 point = pile.centers[a];
    point[axis] -= 0.5;
    point[axis_0] = corner & 1 ? face.most[0] : face.least[0];
    point[axis_1] = corner & 2 ? face.most[1] : face.least[1];
    pile.add_contact(a, b, point, normal, options.mu, load_kg / 4);
  }
}

}  // namespace

StepProblem make_pile(std::uint64_t seed, const PileOptions& options) {
  Structure pile(seed, options.cfm);
  const int per_layer = options.columns * options.rows;
  for (int z = 0; z < options.layers; ++z) {
    const double shift = z % 2 == 0 ? 0 : 1.0 / 3;
    for (int i = 0; i < per_layer; ++i) {
      const double mass_kg = pile.random.chance(0.5) ? 1 : options.mass_ratio;
      const Vec3 center = {i % options.columns + shift, i / options.columns + shift, z + 0.5};
      pile.add_body(center, mass_kg, {mass_kg / 6, mass_kg / 6, mass_kg / 6});
    }
  }
  for (int a = 0; a < pile.problem.body_count(); ++a) {
    const Vec3 center = pile.centers[a];
    const double load_kg = pile.problem.mass[36 * a] * (options.layers - a / per_layer);
    if (a < per_layer) add_face(pile, a, -1, {center[0], center[1], center[2] - 1}, 2, options, load_kg);
    for (int b = 0; b < a; ++b) {
      const Vec3 gap = subtract(center, pile.centers[b]);
      for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(gap[axis] - 1) > 1e-6) continue;
        add_face(pile, a, b, pile.centers[b], axis, options, axis == 2 ? load_kg : 0.1 * load_kg);
      }
    }
  }
  return pile.problem;
}

StepProblem make_chain(std::uint64_t seed, const ChainOptions& options) {
  Structure chain(seed, options.cfm);
  const int n = options.links;
  const double turn = 2 * 3.14159265358979324 / n;
  const double radius_m = 0.3 / turn;
  const auto on_circle = [&](double link) {
    return Vec3{radius_m * std::cos(turn * link), radius_m * std::sin(turn * link), 2};
  };
  for (int i = 0; i < n; ++i) {
    const double mass_kg = i == n - 1 ? options.bob_mass_kg : 1;
    chain.add_body(on_circle(i), mass_kg, {0.002 * mass_kg, 0.008 * mass_kg, 0.008 * mass_kg});
  }
  const auto join = [&](int a, int b, const Vec3& anchor) {
    options.hinges ? chain.add_hinge(a, b, anchor) : chain.add_ball(a, b, anchor);
  };
  join(0, -1, on_circle(-0.5));
  for (int i = 1; i < n; ++i) {
    join(i, i - 1, on_circle(i - 0.5));
    if (options.doubled && i % 10 == 0) join(i, i - 1, on_circle(i - 0.5));
  }
  if (options.closed) join(n - 1, 0, on_circle(n - 0.5));
  for (int k = 0; k < options.extra_joints; ++k) {
    const int a = chain.random.integer(2, n - 1);
    const int b = chain.random.integer(0, a - 2);
    chain.add_ball(a, b, on_circle((a + b) / 2.0));
  }
  return chain.problem;
}

}  // namespace cleave
