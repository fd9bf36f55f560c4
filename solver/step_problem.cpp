#include "solver/step_problem.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "solver/row_arrays.h"

namespace cleave {
namespace {

// World-frame inertias are products of rotations: their asymmetry is a few rounding errors of the larger
// diagonal.
constexpr double kSymmetryTolerance = 1e-10;
// A Cholesky pivot below this fraction of its diagonal entry is rounding error, not mass.
constexpr double kPivotTolerance = 1e-14;

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string error_at(const char* array, std::size_t index, double value, const std::string& allowed) {
  return std::string(array) + "[" + std::to_string(index) + "] = " + number_text(value) +
         ", allowed: " + allowed;
}

template <typename T>
std::string find_size_error(const char* array, const std::vector<T>& values, std::size_t each,
                            std::size_t count, const char* of) {
  if (values.size() == each * count) return {};
  return "size of " + std::string(array) + " = " + std::to_string(values.size()) +
         ", allowed: " + std::to_string(each * count) + " (" + std::to_string(each) + " for each of " +
         std::to_string(count) + " " + of + ")";
}

std::string find_shape_error(const StepProblem& p) {
  if (p.free_velocity.size() % 6 != 0) {
    return "size of free_velocity = " + std::to_string(p.free_velocity.size()) + ", allowed: a multiple of 6";
  }
  const std::size_t n = p.body_count();
  const std::size_t m = p.row_count();
  std::string error = find_size_error("mass", p.mass, 36, n, "bodies");
  visit_row_arrays([&](const char* name, auto member, std::size_t width, RowArray kind) {
    if (!error.empty() || (kind == RowArray::may_be_empty && (p.*member).empty())) return;
    error = find_size_error(name, p.*member, width, m, "rows");
  });
  return error;
}

std::string find_infinite(const char* array, const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) return error_at(array, i, values[i], "finite numbers");
  }
  return {};
}

std::string find_negative(const char* array, const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] >= 0) || std::isinf(values[i])) return error_at(array, i, values[i], "finite and >= 0");
  }
  return {};
}

std::string find_number_error(const StepProblem& p) {
  if (!(p.h_s > 0) || std::isinf(p.h_s)) return "h_s = " + number_text(p.h_s) + ", allowed: finite and > 0";
  std::string error;
  const auto wrong = [&error](std::string found) { return !(error = std::move(found)).empty(); };
  if (wrong(find_infinite("mass", p.mass)) || wrong(find_infinite("free_velocity", p.free_velocity)) ||
      wrong(find_infinite("jacobian", p.jacobian)) || wrong(find_infinite("rhs", p.rhs)) ||
      wrong(find_negative("compliance", p.compliance)) ||
      wrong(find_negative("friction_coefficient", p.friction_coefficient)) ||
      wrong(find_infinite("contact_point", p.contact_point)) ||
      wrong(find_infinite("warm_impulse", p.warm_impulse)) ||
      wrong(find_infinite("box_angle_rad", p.box_angle_rad))) {
    return error;
  }
  return {};
}

std::string find_body_error(const StepProblem& p, std::size_t r) {
  const int n = p.body_count();
  const int first = p.row_body[2 * r];
  const int second = p.row_body[2 * r + 1];
  const std::string last = std::to_string(n - 1);
  if (first < 0 || first >= n) return error_at("row_body", 2 * r, first, "0 to " + last);
  if (second < -1 || second >= n) return error_at("row_body", 2 * r + 1, second, "-1 (static) to " + last);
  if (first == second)
    return error_at("row_body", 2 * r + 1, second, "another body than the first of the row");
  return {};
}

std::string find_bound_error(const StepProblem& p, std::size_t r) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double lower = p.lower[r];
  const double upper = p.upper[r];
  if (!(lower < kInfinity)) return error_at("lower", r, lower, "< +infinity");
  if (!(upper > -kInfinity)) return error_at("upper", r, upper, "> -infinity");
  if (lower > upper) return error_at("lower", r, lower, "<= upper, which is " + number_text(upper));
  return {};
}

std::string find_kind_error(const StepProblem& p, std::size_t r) {
  const RowKind kind = p.row_kind[r];
  const int normal = p.friction_row[r];
  if (kind != RowKind::bilateral && kind != RowKind::normal && kind != RowKind::friction) {
    return error_at("row_kind", r, static_cast<int>(kind), "0 (bilateral), 1 (normal), 2 (friction)");
  }
  if (kind != RowKind::friction) {
    return normal == -1 ? std::string()
                        : error_at("friction_row", r, normal, "-1 for a row that is not friction");
  }
  if (normal < 0 || normal >= static_cast<int>(r) || p.row_kind[normal] != RowKind::normal) {
    return error_at("friction_row", r, normal, "the index of a normal row before it");
  }
  return {};
}

bool same_bodies(const StepProblem& p, std::size_t r, std::size_t other) {
  return p.row_body[2 * r] == p.row_body[2 * other] && p.row_body[2 * r + 1] == p.row_body[2 * other + 1];
}

// Arrays that speak of one row must agree, and so must the rows of one contact and of one constraint.
std::string find_pair_error(const StepProblem& p, std::size_t r) {
  if (p.row_kind[r] != RowKind::friction && p.friction_coefficient[r] != 0)
    return error_at("friction_coefficient", r, p.friction_coefficient[r], "0 for a row that is not friction");
  if (p.row_kind[r] == RowKind::friction && !same_bodies(p, r, p.friction_row[r]))
    return error_at("friction_row", r, p.friction_row[r], "a normal row between the same bodies");
  if (r > 0 && p.row_constraint[r] == p.row_constraint[r - 1] && !same_bodies(p, r, r - 1))
    return error_at("row_constraint", r, p.row_constraint[r],
                    "another id than that of the row before, which joins other bodies");
  return {};
}

// How many rows after normal row r are friction rows of it, between the same bodies, without a gap.
int count_tangents(const StepProblem& p, std::size_t r) {
  std::size_t next = r + 1;
  while (next < p.rhs.size() && p.row_kind[next] == RowKind::friction &&
         p.friction_row[next] == static_cast<int>(r) && same_bodies(p, next, r))
    ++next;
  return static_cast<int>(next - r) - 1;
}

// A turned box has the bounds of its axes in the places of its rows, and a compliance that turning leaves as
// it is.
std::string find_turned_box_error(const StepProblem& p, std::size_t r) {
  if (p.box_angle_rad.empty() || p.box_angle_rad[r] == 0) return {};
  if (count_tangents(p, r) != 2) {
    return error_at("box_angle_rad", r, p.box_angle_rad[r],
                    "0 but on a normal row that its two friction rows, of the same bodies, follow");
  }
  if (p.compliance[r + 1] != p.compliance[r + 2]) {
    return error_at("box_angle_rad", r, p.box_angle_rad[r],
                    "0 where the two friction rows differ in compliance, here " +
                        number_text(p.compliance[r + 1]) + " and " + number_text(p.compliance[r + 2]));
  }
  return {};
}

bool is_curved(const StepProblem& p, std::size_t r) {
  return !p.contact_set.empty() && p.contact_set[r] != ContactSet::box;
}

// Of a friction row: those of a contact without a box, or with a turned one, stand right behind their normal
// row, and nowhere else.
std::string find_stray_error(const StepProblem& p, std::size_t r) {
  if (p.row_kind[r] != RowKind::friction) return {};
  const int normal = p.friction_row[r];
  const bool is_turned = !p.box_angle_rad.empty() && p.box_angle_rad[normal] != 0;
  if (!(is_curved(p, normal) || is_turned) || static_cast<int>(r) <= normal + count_tangents(p, normal))
    return {};
  const std::string set = is_turned ? "box_angle_rad there is not 0" : "contact_set there is no box";
  return error_at("friction_row", r, normal,
                  "another row, as " + set + ", and the friction rows of such a contact follow it");
}

// The coefficient of a cone is one number, and its rows have no bounds of their own.
std::string find_curved_row_error(const StepProblem& p, std::size_t r, std::size_t normal) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double mu = p.friction_coefficient[normal + 1];
  if (r > normal && !(p.friction_coefficient[r] > 0))
    return error_at("friction_coefficient", r, p.friction_coefficient[r], "> 0 where contact_set is no box");
  if (r > normal && p.friction_coefficient[r] != mu)
    return error_at("friction_coefficient", r, p.friction_coefficient[r],
                    "that of the row before, " + number_text(mu) + ", where contact_set is no box");
  const double lower = r > normal ? -kInfinity : 0;
  if (p.lower[r] != lower)
    return error_at("lower", r, p.lower[r], number_text(lower) + " where contact_set is no box");
  if (p.upper[r] != kInfinity) return error_at("upper", r, p.upper[r], "inf where contact_set is no box");
  return {};
}

std::string find_contact_set_error(const StepProblem& p, std::size_t r) {
  if (p.contact_set.empty()) return {};
  const int set = static_cast<int>(p.contact_set[r]);
  if (set > static_cast<int>(ContactSet::coulomb))
    return error_at("contact_set", r, set, "0 (box), 1 (cone), 2 (coulomb)");
  if (!is_curved(p, r)) return {};
  const int tangents = p.row_kind[r] == RowKind::normal ? count_tangents(p, r) : 0;
  if (tangents != 1 && tangents != 2)
    return error_at(
        "contact_set", r, set,
        "0 (box) but on a normal row that its one or two friction rows, of the same bodies, follow");
  for (std::size_t k = r; k <= r + tangents; ++k)
    if (std::string error = find_curved_row_error(p, k, r); !error.empty()) return error;
  if (!p.box_angle_rad.empty() && p.box_angle_rad[r] != 0)
    return error_at("box_angle_rad", r, p.box_angle_rad[r], "0 where contact_set is no box");
  return {};
}

std::string find_row_error(const StepProblem& p) {
  for (std::size_t r = 0; r < p.rhs.size(); ++r) {
    for (const auto find : {find_body_error, find_bound_error, find_kind_error, find_turned_box_error,
                            find_stray_error, find_contact_set_error, find_pair_error}) {
      if (std::string error = find(p, r); !error.empty()) return error;
    }
  }
  return {};
}

// Cholesky factorisation of one block; the first coordinate whose pivot is lost, or -1. The lower triangle is
// read.
int find_lost_pivot(const double* block) {
  double factor[6][6];
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) {
      double rest = block[6 * i + j];
      for (int k = 0; k < j; ++k) rest -= factor[i][k] * factor[j][k];
      if (i == j && !(rest > kPivotTolerance * std::abs(block[7 * i]))) return i;
      factor[i][j] = i == j ? std::sqrt(rest) : rest / factor[j][j];
    }
  }
  return -1;
}

std::string find_mass_error(const StepProblem& p) {
  for (std::size_t body = 0; body < p.mass.size() / 36; ++body) {
    const double* block = &p.mass[36 * body];
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < i; ++j) {
        const double entry = block[6 * i + j];
        const double mirrored = block[6 * j + i];
        const double size = std::max(std::abs(block[7 * i]), std::abs(block[7 * j]));
        if (std::abs(entry - mirrored) > kSymmetryTolerance * size) {
          return error_at(
              "mass", 36 * body + 6 * i + j, entry,
              "symmetric positive definite blocks; the mirrored entry is " + number_text(mirrored));
        }
      }
    }
    if (const int i = find_lost_pivot(block); i != -1) {
      return error_at("mass", 36 * body + 7 * i, block[7 * i],
                      "symmetric positive definite blocks; the one of body " + std::to_string(body) +
                          " is not positive definite in its first " + std::to_string(i + 1) + " coordinates");
    }
  }
  return {};
}

}  // namespace

std::string find_problem_error(const StepProblem& problem) {
  for (const auto find : {find_shape_error, find_number_error, find_row_error, find_mass_error}) {
    if (std::string error = find(problem); !error.empty()) return error;
  }
  return {};
}

}  // namespace cleave
