// cleave export --format mtx: every matrix, read back entry by entry, against its definition in dense arrays.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "harness/files/matrix_market.h"
#include "tests/harness/problem_file_sample.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

using Dense = std::vector<std::vector<double>>;

// As the format is defined: symmetric files hold the lower triangle. Repeated places and the upper triangle fail the test.
Dense read_matrix_market(const std::string& text) {
  std::istringstream lines(text);
  std::string line, symmetry;
  std::getline(lines, line);
  std::istringstream words(line);
  for (int k = 0; k < 5; ++k) words >> symmetry;
  EXPECT_TRUE(line.starts_with("%%MatrixMarket matrix coordinate real ")) << line;
  while (lines.peek() == '%') std::getline(lines, line);
  int rows = 0, columns = 0, entries = 0, row = 0, column = 0, read = 0;
  lines >> rows >> columns >> entries;
  Dense matrix(rows, std::vector<double>(columns, 0.0));
  for (double value = 0; lines >> row >> column >> value; ++read) {
    EXPECT_EQ(matrix.at(row - 1).at(column - 1), 0) << row << " " << column << " twice";
    EXPECT_NE(value, 0);
    matrix[row - 1][column - 1] = value;
    if (symmetry != "symmetric") continue;
    EXPECT_GE(row, column);
    matrix[column - 1][row - 1] = value;
  }
  EXPECT_EQ(read, entries);
  return matrix;
}

Dense mass(const StepProblem& p) {
  const int n = p.body_count();
  Dense matrix(6 * n, std::vector<double>(6 * n, 0.0));
  for (int i = 0; i < n; ++i)
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b) matrix[6 * i + a][6 * i + b] = p.mass[36 * i + 6 * a + b];
  return matrix;
}

Dense jacobian(const StepProblem& p) {
  Dense matrix(p.row_count(), std::vector<double>(6 * p.body_count(), 0.0));
  for (int r = 0; r < p.row_count(); ++r)
    for (int k = 0; k < 12; ++k)
      if (p.row_body[2 * r + k / 6] >= 0)
        matrix[r][6 * p.row_body[2 * r + k / 6] + k % 6] = p.jacobian[12 * r + k];
  return matrix;
}

Dense system(const StepProblem& p) {
  Dense matrix = mass(p);
  const Dense j = jacobian(p);
  for (std::size_t a = 0; a < matrix.size(); ++a)
    for (std::size_t b = 0; b < matrix.size(); ++b)
      for (int r = 0; r < p.row_count(); ++r) matrix[a][b] += j[r][a] * j[r][b] / p.compliance[r];
  return matrix;
}

// With mass blocks that are full, and compliances that differ from row to row.
StepProblem full_problem(int bodies, std::uint64_t seed) {
  StepProblem problem = sample_problem(bodies, seed);
  SampleRandom random(seed + 1);
  for (int i = 0; i < bodies; ++i)
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < a; ++b)
        problem.mass[36 * i + 6 * a + b] = problem.mass[36 * i + 6 * b + a] = 0.1 * random.around_zero();
  for (double& compliance : problem.compliance) compliance = 1e-3 * (1 + random.uniform());
  return problem;
}

std::string text_of(const std::string& name, const StepProblem& problem) {
  for (const MatrixOfProblem& matrix : matrices_of_problem())
    if (name == matrix.name) return matrix.text(problem);
  throw std::logic_error(name);
}

TEST(MatrixMarket, HoldsTheMatricesOfAProblem) {
  for (const int bodies : {1, 2, 9}) {
    const StepProblem problem = full_problem(bodies, 7);
    EXPECT_EQ(read_matrix_market(text_of("M", problem)), mass(problem));
    EXPECT_EQ(read_matrix_market(text_of("J", problem)), jacobian(problem));
    const Dense found = read_matrix_market(text_of("H", problem)), expected = system(problem);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t a = 0; a < found.size(); ++a)
      for (std::size_t b = 0; b < found.size(); ++b)
        EXPECT_NEAR(found[a][b], expected[a][b], 1e-12 * std::abs(expected[a][a] + expected[b][b]));
  }
}

TEST(MatrixMarket, HasNoHWithoutCompliance) {
  StepProblem problem = full_problem(3, 7);
  problem.compliance[2] = 0;
  try {
    text_of("H", problem);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("compliance of row 2 = 0, allowed: > 0"), std::string::npos);
  }
}

TEST(MatrixMarket, IsWrittenByExport) {
  const TemporaryDirectory directory;
  ProblemFile file = sample_file(4, 3);
  file.problem = full_problem(4, 3);
  write_problem_file(directory / "a.h5", file);
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"export", directory / "a.h5", "--out", directory / "a.mtx",
                                          "--force"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_cleave(arguments);
  };
  for (const MatrixOfProblem& matrix : matrices_of_problem()) {
    ASSERT_EQ(run({"--format", "mtx", "--matrix", matrix.name}).exit_code, 0);
    EXPECT_EQ(read_text(directory / "a.mtx"), matrix.text(file.problem)) << matrix.name;
  }
  const auto refusal = [&](std::vector<std::string> more) {
    const ProgramResult result = run(more);
    EXPECT_EQ(result.exit_code, 1);
    return result.err;
  };
  EXPECT_EQ(refusal({"--format", "mtx"}),
            "cleave export: --matrix: is required with --format mtx; choices: M, J, H\n");
  EXPECT_EQ(refusal({"--format", "mtx", "--matrix", "Q"}),
            "cleave export: --matrix: 'Q' is unknown; choices: M, J, H\n");
  EXPECT_EQ(refusal({"--format", "metis", "--matrix", "M"}),
            "cleave export: --matrix: --format metis has none; leave it out\n");
}

}  // namespace
}  // namespace cleave
