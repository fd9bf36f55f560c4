// What each constant of the interior point buys: solves recorded problems with one constant changed at a time
// and counts factorisations. scripts/ablate_interior_point records the problems and prints the table.
//
//   interior_point_benchmark [--constant NAME]... FILE...
//
// Writes CSV to standard output, a line a constant, value and problem. kind: default (as the solver has it,
// constant "-", first), off (the value takes the constant's effect away), or other. Without --constant every
// constant is changed. proximal: the first attempt ended above the limit, and proximal steps followed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "harness/files/problem_file.h"
#include "solver/direct_solver.h"
#include "solver/residual.h"
#include "tests/solver/interior_constants_list.h"

namespace cleave {
namespace {

struct NamedProblem {
  std::string name;
  StepProblem problem;
};

struct Request {
  std::vector<std::string> constants;  // none: all
  std::vector<NamedProblem> problems;
};

// Every solve starts from the recorded impulses, as a step of a run does.
void solve_all(const Request& request, const InteriorConstants& constants, const std::string& label) {
  const auto solver = make_direct_solver("interior-point", "monolithic", SolveOptions{}, Settings(),
                                         make_interior_point(constants));
  for (const auto& [name, problem] : request.problems) {
    Solution solution;
    solution.impulse = problem.warm_impulse;
    const SolveSummary summary = solver->solve(problem, {}, solution);
    const ResidualReport verdict = judge(problem, solution.impulse);
    std::printf("%s,%s,%d,%d,%d,%.3g\n", label.c_str(), name.c_str(), summary.factorizations,
                summary.fallbacks > 0 ? 1 : 0, verdict.exact ? 1 : 0, verdict.residual_m_per_s);
  }
  std::fflush(stdout);
}

void try_value(const Request& request, std::string_view constant, double value, const char* kind) {
  InteriorConstants changed;
  visit_constants(changed, [&](std::string_view name, auto& member, const Alternatives&) {
    if (name == constant) member = static_cast<std::remove_reference_t<decltype(member)>>(value);
  });
  char label[100];
  std::snprintf(label, sizeof label, "%s,%g,%s", std::string(constant).c_str(), value, kind);
  solve_all(request, changed, label);
}

void ablate(const Request& request) {
  std::puts("constant,value,kind,problem,factorizations,proximal,exact,residual_m_per_s");
  solve_all(request, {}, "-,-,default");
  const InteriorConstants defaults;
  visit_constants(defaults, [&](const char* name, auto&, const Alternatives& tried) {
    if (!request.constants.empty() && std::ranges::count(request.constants, name) == 0) return;
    std::fprintf(stderr, "%s\n", name);
    if (!std::isnan(tried.off)) try_value(request, name, tried.off, "off");
    for (double value : tried.others) try_value(request, name, value, "other");
  });
}

void check_constant(const std::string& wanted) {
  std::string known;
  bool found = false;
  const InteriorConstants defaults;
  visit_constants(defaults, [&](const char* name, auto&, const Alternatives&) {
    found = found || wanted == name;
    known += (known.empty() ? "" : ", ") + std::string(name);
  });
  if (!found) throw std::invalid_argument("--constant is '" + wanted + "', expected one of " + known);
}

Request parse(const std::vector<std::string>& words) {
  Request request;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (words[k] == "--constant") {
      if (++k == words.size()) throw std::invalid_argument("--constant needs a name");
      check_constant(words[k]);
      request.constants.push_back(words[k]);
    } else {
      request.problems.push_back({words[k], read_problem_file(words[k]).problem});
    }
  }
  if (request.problems.empty()) throw std::invalid_argument("FILE: at least one problem file is required");
  return request;
}

}  // namespace
}  // namespace cleave

int main(int argc, char** argv) {
  try {
    cleave::ablate(cleave::parse({argv + 1, argv + argc}));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "interior_point_benchmark: %s\n", error.what());
    return 1;
  }
}
