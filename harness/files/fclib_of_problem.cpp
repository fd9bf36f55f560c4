#include <cmath>
#include <stdexcept>
#include <string>

#include "harness/base/numbers.h"
#include "harness/files/fclib_problem.h"

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

[[noreturn]] void refuse(const std::string& array, int row, const std::string& value,
                         const std::string& allowed) {
  throw std::invalid_argument(array + "[" + std::to_string(row) + "] = " + value + ", allowed: " + allowed);
}

bool has_bounds(const StepProblem& problem, int row, double lower, double upper) {
  return problem.lower[row] == lower && problem.upper[row] == upper;
}

// The number of friction rows behind a normal row.
int tangents_of(const StepProblem& problem, int normal) {
  int count = 0;
  while (normal + count + 1 < problem.row_count() && problem.friction_row[normal + count + 1] == normal)
    ++count;
  return count;
}

// Friction rows that can carry nothing and follow no normal impulse.
bool is_frictionless(const StepProblem& problem, int normal, int tangents) {
  for (int r = normal + 1; r <= normal + tangents; ++r)
    if (problem.friction_coefficient[r] != 0 || !has_bounds(problem, r, 0, 0)) return false;
  return true;
}

double coefficient_of(const StepProblem& problem, int normal, int tangents) {
  if (is_frictionless(problem, normal, tangents)) return 0;
  const ContactSet set = problem.contact_set.empty() ? ContactSet::box : problem.contact_set[normal];
  if (set != ContactSet::coulomb)
    refuse("contact_set", normal, std::to_string(static_cast<int>(set)),
           "2 (coulomb), the only law of FCLIB; --friction coulomb gives it to contacts with a coefficient");
  return problem.friction_coefficient[normal + 1];
}

// The columns of a contact: one tangent, where all contacts with friction rows have one.
int find_dimension(const StepProblem& problem) {
  int dimension = 0;
  for (int r = 0; r < problem.row_count(); ++r) {
    const int tangents = tangents_of(problem, r);
    if (tangents == 0) continue;
    if (tangents > 2 || (dimension != 0 && tangents + 1 != dimension))
      refuse("friction_row", r + 1, std::to_string(r),
             "contacts that all have one tangent, or all two; this one has " + std::to_string(tangents));
    dimension = tangents + 1;
  }
  return dimension == 0 ? 3 : dimension;
}

class Export {
 public:
  explicit Export(const StepProblem& problem) : problem_(problem) {
    global_.dimension = find_dimension(problem);
    global_.bodies = problem.body_count();
    global_.h_s = problem.h_s;
    add_bodies();
    for (int r = 0; r < problem.row_count();) r += add_constraint(r);
    for (FclibMatrix* matrix : {&global_.M, &global_.H, &global_.G}) {
      matrix->rows = static_cast<int>(global_.f.size());
      sum_entries(matrix->entries);
    }
    global_.M.columns = global_.M.rows;
    global_.H.columns = static_cast<int>(global_.w.size());
    global_.G.columns = static_cast<int>(global_.b.size());
  }
  FclibGlobal take() { return std::move(global_); }

 private:
  void add_bodies() {
    for (int i = 0; i < problem_.body_count(); ++i)
      for (int a = 0; a < 6; ++a) {
        double momentum = 0;
        for (int b = 0; b < 6; ++b) {
          const double mass = problem_.mass[36 * std::size_t(i) + 6 * a + b];
          global_.M.entries.push_back({6 * i + a, 6 * i + b, mass});
          momentum += mass * problem_.free_velocity[6 * std::size_t(i) + b];
        }
        global_.f.push_back(momentum);
      }
  }

  // J_r^T, the spring and the constant, in the next column.
  void add_column(int row, FclibMatrix& matrix, std::vector<double>& constants) {
    const int column = static_cast<int>(constants.size());
    for (const MatrixEntry& entry : jacobian_entries(problem_, row))
      matrix.entries.push_back({entry.column, column, entry.value});
    if (const double compliance = problem_.compliance[row]; compliance > 0) {
      const int spring = static_cast<int>(global_.f.size());
      global_.M.entries.push_back({spring, spring, 1 / compliance});
      matrix.entries.push_back({spring, column, 1});
      global_.f.push_back(0);
    }
    constants.push_back(-problem_.rhs[row]);
  }

  // Returns how many rows it has.
  int add_constraint(int row) {
    if (problem_.friction_row[row] >= 0)
      refuse("friction_row", row, std::to_string(problem_.friction_row[row]),
             "the normal row before it, or before its other tangent");
    if (has_bounds(problem_, row, -kInfinity, kInfinity)) {
      add_column(row, global_.G, global_.b);
      return 1;
    }
    if (!has_bounds(problem_, row, 0, kInfinity))
      refuse("lower and upper", row,
             number_text(problem_.lower[row]) + " and " + number_text(problem_.upper[row]),
             "-inf and inf of joints, 0 and inf of contacts");
    return add_contact(row);
  }

  int add_contact(int normal) {
    const int tangents = tangents_of(problem_, normal);
    global_.mu.push_back(coefficient_of(problem_, normal, tangents));
    for (int r = normal; r <= normal + tangents; ++r) add_column(r, global_.H, global_.w);
    global_.w.resize(global_.dimension * global_.mu.size(), 0.0);
    return 1 + tangents;
  }

  const StepProblem& problem_;
  FclibGlobal global_;
};

}  // namespace

FclibGlobal fclib_of_problem(const StepProblem& problem) { return Export(problem).take(); }

}  // namespace cleave
