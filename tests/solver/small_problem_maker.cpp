#include <algorithm>

#include "tests/solver/problem_makers.h"

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class SmallProblemMaker {
 public:
  SmallProblemMaker(std::uint64_t seed, const SmallProblemOptions& options)
      : random_(seed), options_(options) {
    problem_.h_s = kTestStep_s;
    at_rest_ = random_.chance(0.05);
    integers_ = random_.chance(0.3);
    compliance_ = random_.log_uniform(options.least_cfm, options.most_cfm) / kTestStep_s;
  }

  StepProblem make() {
    const int bodies = random_.integer(1, options_.most_bodies);
    for (int i = 0; i < bodies; ++i) add_body();
    const int rows = random_.integer(1, options_.most_rows);
    while (problem_.row_count() < rows) add_constraint(rows - problem_.row_count());
    if (options_.feasible) make_feasible();
    return problem_;
  }

 private:
  // A third of the blocks are full: nothing in a step problem says that a mass block is block-diagonal.
  void add_body() {
    const double mass_kg =
        random_.chance(0.5) ? random_.uniform(1, 2) : random_.log_uniform(1, options_.mass_ratio);
    Vec3 inertia;
    for (double& entry : inertia) entry = mass_kg * random_.log_uniform(0.05, 1);
    std::array<double, 6> velocity{};
    for (double& entry : velocity) entry = at_rest_ ? 0 : draw(-2, 2);
    const int body = append_body(problem_, mass_kg, inertia, velocity);
    if (!random_.chance(1.0 / 3)) return;
    for (int k = 0; k < 3; ++k) {  // adds a multiple of x x^T, three times
      std::array<double, 6> x;
      for (double& entry : x) entry = random_.uniform(-1, 1);
      for (int i = 0; i < 36; ++i) problem_.mass[36 * body + i] += 0.3 * mass_kg * (x[i / 6] * x[i % 6]);
    }
  }

  double draw(double least, double most) {
    return integers_ ? random_.integer(static_cast<int>(least), static_cast<int>(most))
                     : random_.uniform(least, most);
  }

  RowSpec draw_row() {
    RowSpec row;
    const int n = problem_.body_count();
    row.body_a = random_.integer(0, n - 1);
    row.body_b = random_.integer(-1, n - 1);
    if (row.body_b == row.body_a) row.body_b = -1;
    for (double& entry : row.jacobian_a) entry = draw(-1, 1);
    for (double& entry : row.jacobian_b) entry = draw(-1, 1);  // must be ignored where body_b is static
    row.jacobian_a[random_.integer(0, 5)] = 1;
    row.rhs = at_rest_ || random_.chance(0.4) ? 0 : draw(-2, 2);
    row.compliance = compliance_ * (random_.chance(0.2) ? random_.log_uniform(1, 100) : 1);
    row.constraint = next_constraint_++;
    return row;
  }

  void add_constraint(int rows_left) {
    const int choice = random_.integer(0, 9);
    if (choice < 2 && problem_.row_count() > 0) return add_copy();
    if (choice < 4) {
      append_row(problem_, draw_row());
    } else if (choice < 6) {
      append_row(problem_, draw_bounded_row());
    } else {
      add_contact(std::min(rows_left - 1, random_.integer(0, 2)));
    }
  }

  // Bounds of any shape; the row is called normal, which says nothing about its bounds.
  RowSpec draw_bounded_row() {
    RowSpec row = draw_row();
    row.kind = RowKind::normal;
    const double reach = random_.log_uniform(1e-2, 1e2);
    switch (random_.integer(0, 3)) {
      case 0:
        row.upper = random_.chance(0.5) ? 0 : reach;
        break;
      case 1:
        row.lower = random_.chance(0.5) ? 0 : -reach;
        break;
      case 2:
        row.lower = row.upper = random_.chance(0.5) ? 0 : draw(-2, 2);
        break;
      default:
        row.lower = -reach, row.upper = reach * random_.uniform(0, 1);
    }
    if (random_.chance(0.3)) row.lower += reach / 2, row.upper += reach / 2;
    if (options_.zero_inside_bounds)
      row.lower = std::min(row.lower, 0.0), row.upper = std::max(row.upper, 0.0);
    return row;
  }

  void add_contact(int friction_rows) {
    RowSpec row = draw_row();
    row.kind = RowKind::normal;
    row.lower = 0;
    const int normal = append_row(problem_, row);
    const double bound = random_.chance(0.2) ? 0 : random_.log_uniform(1e-2, 1e2);
    for (int k = 0; k < friction_rows; ++k) {
      for (double& entry : row.jacobian_a) entry = draw(-1, 1);
      for (double& entry : row.jacobian_b) entry = draw(-1, 1);
      row.kind = RowKind::friction;
      row.rhs = 0;
      row.lower = -bound;
      row.upper = bound;
      row.friction_row = normal;
      row.friction_coefficient = 0.5;
      append_row(problem_, row);
    }
  }

  // Right-hand sides that some one velocity satisfies with w on the allowed side of every unbounded
  // direction.
  void make_feasible() {
    std::vector<double> target(problem_.free_velocity.size());
    for (double& entry : target) entry = at_rest_ || random_.chance(0.5) ? 0 : draw(-2, 2);
    for (int r = 0; r < problem_.row_count(); ++r) {
      double rhs = 0;
      for (int k = 0; k < 12; ++k) {
        const int body = problem_.row_body[2 * r + k / 6];
        if (body >= 0) rhs += problem_.jacobian[12 * r + k] * target[6 * body + k % 6];
      }
      const bool unbounded_above = problem_.upper[r] == kInfinity;
      const bool unbounded_below = problem_.lower[r] == -kInfinity;
      const double slack = random_.chance(0.5) ? 0 : draw(0, 2);
      if (unbounded_above && !unbounded_below) rhs -= slack;
      if (unbounded_below && !unbounded_above) rhs += slack;
      problem_.rhs[r] = rhs;
    }
  }

  // The same row once more, or its mirror image: what redundant contacts and doubled joints look like.
  void add_copy() {
    const int r = random_.integer(0, problem_.row_count() - 1);
    RowSpec row;
    const double sign = random_.chance(0.3) ? -1 : 1;
    row.body_a = problem_.row_body[2 * r];
    row.body_b = problem_.row_body[2 * r + 1];
    for (int k = 0; k < 6; ++k) {
      row.jacobian_a[k] = sign * problem_.jacobian[12 * r + k];
      row.jacobian_b[k] = sign * problem_.jacobian[12 * r + 6 + k];
    }
    row.rhs = random_.chance(0.7) ? sign * problem_.rhs[r] : 0;
    row.compliance = problem_.compliance[r];
    row.kind = problem_.row_kind[r];
    row.lower = sign > 0 ? problem_.lower[r] : -problem_.upper[r];
    row.upper = sign > 0 ? problem_.upper[r] : -problem_.lower[r];
    row.friction_row = problem_.friction_row[r];
    row.friction_coefficient = problem_.friction_coefficient[r];
    row.constraint = next_constraint_++;
    append_row(problem_, row);
  }

  SeededRandom random_;
  SmallProblemOptions options_;
  StepProblem problem_;
  double compliance_ = 0;
  bool at_rest_ = false;
  bool integers_ = false;
  int next_constraint_ = 0;
};

}  // namespace

StepProblem make_small_problem(std::uint64_t seed, const SmallProblemOptions& options) {
  return SmallProblemMaker(seed, options).make();
}

}  // namespace cleave
