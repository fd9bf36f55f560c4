#include "harness/peers/siconos_command.h"

#include <cstdio>
#include <memory>
#include <stdexcept>

#include "harness/base/csv_text.h"
#include "harness/base/numbers.h"
#include "harness/base/refusals.h"
#include "harness/base/value_spans.h"
#include "harness/files/problem_file.h"
#include "harness/peers/siconos.h"
#include "solver/residual.h"

namespace cleave {
namespace {

double error_of(const std::string& path, const StepProblem& problem, std::span<const double> impulse) {
  return in_context(path, [&] { return siconos_error(problem, impulse); });
}

// One line a stored solution. Velocities are compared with those of the first one, as names sort.
void print_solutions(const std::string& path) {
  const ProblemFile file = read_problem_file_aloud(path);
  if (file.solutions.empty())
    throw std::invalid_argument(path +
                                ": no solution in it; cleave_peers replay --write-solutions stores them");
  const StoredSolution& first = file.solutions.begin()->second;
  for (const auto& [label, solution] : file.solutions)
    std::printf("%s,%s,%d,%s,%s,%s\n", csv_cell(path).c_str(), csv_cell(solution.solver).c_str(),
                file.problem.row_count(),
                number_text(judge(file.problem, solution.impulse).residual_m_per_s).c_str(),
                number_text(error_of(path, file.problem, solution.impulse)).c_str(),
                number_text(largest_difference(solution.velocity, first.velocity)).c_str());
}

int print_all(const std::vector<std::string>& files) {
  if (files.empty()) throw std::invalid_argument("FILES: at least one problem file is required");
  std::puts("file,solver,rows,residual_m_per_s,siconos_error,velocity_difference_m_per_s");
  for (const std::string& path : files) print_solutions(path);
  return kExitOk;
}

}  // namespace

std::function<int()> declare_siconos_error(CLI::App& app, const std::vector<std::string>&) {
  const auto files = std::make_shared<std::vector<std::string>>();
  app.add_option("files", *files, "problem files with solutions in them")->type_name("FILES");
  return [files] { return print_all(*files); };
}

}  // namespace cleave
