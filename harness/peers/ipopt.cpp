// Solver `ipopt`: Ipopt 3.11, a primal-dual interior-point method with a filter line search, on MUMPS
// (Wächter and Biegler, "On the implementation of an interior-point filter line-search algorithm for
// large-scale nonlinear programming", Mathematical Programming 106, 2006). The box problem as a sparse
// quadratic programme in x = (v, lambda):
//
//     min  1/2 v^T M v + 1/2 lambda^T C lambda - b^T lambda
//     with  M (v - v0) - J^T lambda = 0,  lo <= lambda <= hi.
//
// Put v into the objective and it is the box quadratic programme of step_problem.h. Derivatives are said to
// be constant and bounds not to be relaxed (Ipopt would widen them by 1e-8); everything else is as Ipopt
// ships.
#include <coin/IpStdCInterface.h>

#include <algorithm>
#include <stdexcept>

#include "harness/base/stopwatch.h"
#include "harness/peers/peer.h"

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Triplets {
  std::vector<int> row, column;
  std::vector<double> value;

  void add(int r, int c, double v) { row.push_back(r), column.push_back(c), value.push_back(v); }
  int count() const { return static_cast<int>(value.size()); }
  // y += this * x
  void multiply(const double* x, double* y) const {
    for (int k = 0; k < count(); ++k) y[row[k]] += value[k] * x[column[k]];
  }
};

struct Programme {
  const StepProblem& problem;
  int velocities;            // 6 n
  Triplets hessian;          // lower triangle of diag(M, C)
  Triplets jacobian;         // of M v - J^T lambda
  std::vector<double> side;  // (6 n) M v0
  int iterations = -1;
};

Programme make_programme(const StepProblem& problem) {
  Programme programme{problem, 6 * problem.body_count(), {}, {}, {}};
  const int velocities = programme.velocities;
  programme.side.assign(velocities, 0.0);
  for (int i = 0; i < problem.body_count(); ++i)
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b) {
        const double mass = problem.mass[36 * i + 6 * a + b];
        programme.side[6 * i + a] += mass * problem.free_velocity[6 * i + b];
        if (mass == 0) continue;
        programme.jacobian.add(6 * i + a, 6 * i + b, mass);
        if (b <= a) programme.hessian.add(6 * i + a, 6 * i + b, mass);
      }
  for (int r = 0; r < problem.row_count(); ++r) {
    programme.hessian.add(velocities + r, velocities + r, problem.compliance[r]);
    for (int k = 0; k < 12; ++k) {
      const int body = problem.row_body[2 * r + k / 6];
      if (body >= 0 && problem.jacobian[12 * r + k] != 0)
        programme.jacobian.add(6 * body + k % 6, velocities + r, -problem.jacobian[12 * r + k]);
    }
  }
  return programme;
}

const Programme& programme_of(UserDataPtr data) { return *static_cast<const Programme*>(data); }

// gradient (variables) <- diag(M, C) x - (0, b)
void gradient_at(const Programme& programme, const double* x, double* gradient) {
  const int rows = programme.problem.row_count();
  std::fill_n(gradient, programme.velocities, 0.0);
  for (int r = 0; r < rows; ++r) gradient[programme.velocities + r] = -programme.problem.rhs[r];
  programme.hessian.multiply(x, gradient);
  for (int k = 0; k < programme.hessian.count(); ++k)  // the upper triangle
    if (programme.hessian.row[k] != programme.hessian.column[k])
      gradient[programme.hessian.column[k]] += programme.hessian.value[k] * x[programme.hessian.row[k]];
}

Bool objective(Index n, Number* x, Bool, Number* value, UserDataPtr data) {
  const Programme& programme = programme_of(data);
  std::vector<double> gradient(n);
  gradient_at(programme, x, gradient.data());
  *value = 0;
  for (int i = 0; i < n; ++i) *value += 0.5 * x[i] * gradient[i];
  for (int r = 0; r < programme.problem.row_count(); ++r)
    *value -= 0.5 * programme.problem.rhs[r] * x[programme.velocities + r];
  return TRUE;
}

Bool gradient(Index, Number* x, Bool, Number* values, UserDataPtr data) {
  gradient_at(programme_of(data), x, values);
  return TRUE;
}

Bool constraints(Index, Number* x, Bool, Index m, Number* values, UserDataPtr data) {
  std::fill_n(values, m, 0.0);
  programme_of(data).jacobian.multiply(x, values);
  return TRUE;
}

void give(const Triplets& matrix, Index* rows, Index* columns, Number* values, double factor) {
  if (values == nullptr) {
    std::ranges::copy(matrix.row, rows);
    std::ranges::copy(matrix.column, columns);
  } else {
    std::ranges::transform(matrix.value, values, [&](double value) { return factor * value; });
  }
}

Bool jacobian(Index, Number*, Bool, Index, Index, Index* rows, Index* columns, Number* values,
              UserDataPtr data) {
  give(programme_of(data).jacobian, rows, columns, values, 1);
  return TRUE;
}

Bool hessian(Index, Number*, Bool, Number factor, Index, Number*, Bool, Index, Index* rows, Index* columns,
             Number* values, UserDataPtr data) {
  give(programme_of(data).hessian, rows, columns, values, factor);
  return TRUE;
}

Bool count_iteration(Index, Index iteration, Number, Number, Number, Number, Number, Number, Number, Number,
                     Index, UserDataPtr data) {
  static_cast<Programme*>(data)->iterations = iteration;
  return TRUE;
}

// Ipopt's interface takes texts that it does not change as char*.
void set_word(IpoptProblem ipopt, const char* option, const char* value) {
  if (AddIpoptStrOption(ipopt, const_cast<char*>(option), const_cast<char*>(value)) == FALSE)
    throw std::logic_error(std::string("Ipopt has no option ") + option);
}
void set_number(IpoptProblem ipopt, const char* option, double value) {
  if (AddIpoptNumOption(ipopt, const_cast<char*>(option), value) == FALSE)
    throw std::logic_error(std::string("Ipopt has no option ") + option);
}
void set_integer(IpoptProblem ipopt, const char* option, int value) {
  if (AddIpoptIntOption(ipopt, const_cast<char*>(option), value) == FALSE)
    throw std::logic_error(std::string("Ipopt has no option ") + option);
}

void set_options(IpoptProblem ipopt, const Settings& settings) {
  set_integer(ipopt, "print_level", 0);
  set_word(ipopt, "sb", "yes");  // no banner
  set_word(ipopt, "hessian_constant", "yes");
  set_word(ipopt, "jac_c_constant", "yes");
  set_word(ipopt, "linear_solver", "mumps");
  set_number(ipopt, "bound_relax_factor", 0);
  set_number(ipopt, "tol", settings.number(parameters::peer_tolerance().name));
  set_integer(ipopt, "max_iter", settings.integer(parameters::peer_iterations().name));
}

std::vector<double> bounds(int velocities, const std::vector<double>& of_rows, double none) {
  std::vector<double> all(velocities, none);
  all.insert(all.end(), of_rows.begin(), of_rows.end());
  return all;
}

}  // namespace

PeerAnswer solve_ipopt(const StepProblem& problem, std::span<const double> start, const Settings& settings) {
  Programme programme = make_programme(problem);
  std::vector<double> lower = bounds(programme.velocities, problem.lower, -kInfinity);
  std::vector<double> upper = bounds(programme.velocities, problem.upper, kInfinity);
  IpoptProblem ipopt =
      CreateIpoptProblem(static_cast<int>(lower.size()), lower.data(), upper.data(), programme.velocities,
                         programme.side.data(), programme.side.data(), programme.jacobian.count(),
                         programme.hessian.count(), 0, objective, constraints, gradient, jacobian, hessian);
  set_options(ipopt, settings);
  SetIntermediateCallback(ipopt, count_iteration);
  std::vector<double> x = problem.free_velocity;
  x.insert(x.end(), start.begin(), start.end());
  PeerAnswer answer;
  Stopwatch watch;
  const ApplicationReturnStatus status =
      IpoptSolve(ipopt, x.data(), nullptr, nullptr, nullptr, nullptr, nullptr, &programme);
  answer.solve_ms = watch.lap_ms();
  FreeIpoptProblem(ipopt);
  answer.claims_success = status == Solve_Succeeded;
  if (!answer.claims_success) answer.message = "Ipopt's ApplicationReturnStatus is " + std::to_string(status);
  answer.iterations = programme.iterations;
  answer.impulse.assign(x.begin() + programme.velocities, x.end());
  return answer;
}

}  // namespace cleave
