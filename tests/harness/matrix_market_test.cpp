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

// As the format is defined: symmetric files hold the lower triangle. Repeated places and the upper triangle
// fail the test.
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

// By its definition in dense arrays: interior rows into H, whose inverse Gauss and Jordan find, interface
// rows around it.
Dense schur_complement(const StepProblem& p, const std::vector<int>& part) {
  const Dense j = jacobian(p);
  std::vector<int> across;
  Dense h = mass(p);
  const int size = static_cast<int>(h.size());
  for (int r = 0; r < p.row_count(); ++r) {
    const int a = p.row_body[2 * r], b = p.row_body[2 * r + 1];
    if (b >= 0 && part[a] != part[b]) {
      across.push_back(r);
      continue;
    }
    for (int x = 0; x < size; ++x)
      for (int y = 0; y < size; ++y) h[x][y] += j[r][x] * j[r][y] / p.compliance[r];
  }
  Dense inverse(size, std::vector<double>(size, 0.0));
  for (int k = 0; k < size; ++k) inverse[k][k] = 1;
  for (int k = 0; k < size; ++k) {
    const double pivot = h[k][k];
    for (int y = 0; y < size; ++y) h[k][y] /= pivot, inverse[k][y] /= pivot;
    for (int x = 0; x < size; ++x) {
      const double factor = x == k ? 0 : h[x][k];
      for (int y = 0; y < size; ++y) h[x][y] -= factor * h[k][y], inverse[x][y] -= factor * inverse[k][y];
    }
  }
  Dense s(across.size(), std::vector<double>(across.size(), 0.0));
  for (std::size_t a = 0; a < across.size(); ++a) {
    s[a][a] = p.compliance[across[a]];
    for (std::size_t b = 0; b < across.size(); ++b)
      for (int x = 0; x < size; ++x)
        for (int y = 0; y < size; ++y) s[a][b] += j[across[a]][x] * inverse[x][y] * j[across[b]][y];
  }
  return s;
}

std::string text_of(const std::string& name, const StepProblem& problem,
                    const StoredPartition* partition = nullptr) {
  for (const MatrixOfProblem& matrix : matrices_of_problem())
    if (name == matrix.name) return matrix.text(problem, partition);
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

TEST(MatrixMarket, HoldsTheSchurComplementOfAPartition) {
  const StepProblem problem = full_problem(9, 7);
  for (const std::vector<int>& parts : {std::vector<int>{0, 0, 0, 1, 1, 1, 2, 2, 2},
                                        {0, 1, 2, 3, 4, 5, 6, 7, 8},
                                        {0, 1, 0, 1, 0, 1, 0, 1, 0}}) {
    StoredPartition partition;
    partition.part_of_body = parts;
    const Dense found = read_matrix_market(text_of("S", problem, &partition));
    const Dense expected = schur_complement(problem, parts);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t a = 0; a < found.size(); ++a)
      for (std::size_t b = 0; b < found.size(); ++b)
        EXPECT_NEAR(found[a][b], expected[a][b], 1e-11 * std::abs(expected[a][a] + expected[b][b]));
  }
  StoredPartition whole;
  whole.part_of_body.assign(9, 0);
  EXPECT_TRUE(read_matrix_market(text_of("S", problem, &whole)).empty());
}

// 1e30 drowns the masses, so that the factor of the rows within parts meets a pivot that is none.
TEST(MatrixMarket, HasNoSWhereItsFactorIsNone) {
  StepProblem problem = full_problem(9, 7);
  std::ranges::fill(problem.compliance, 1e-30);
  StoredPartition partition;
  partition.part_of_body = {0, 0, 0, 0, 0, 0, 0, 0, 1};
  EXPECT_THROW(text_of("S", problem, &partition), std::invalid_argument);
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
  file.partitions.clear();
  write_problem_file(directory / "a.h5", file);
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"export", directory / "a.h5", "--out", directory / "a.mtx",
                                          "--force"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_cleave(arguments);
  };
  for (const MatrixOfProblem& matrix : matrices_of_problem()) {
    if (matrix.is_of_partition) continue;
    ASSERT_EQ(run({"--format", "mtx", "--matrix", matrix.name}).exit_code, 0);
    EXPECT_EQ(read_text(directory / "a.mtx"), matrix.text(file.problem, nullptr)) << matrix.name;
  }
  const auto refusal = [&](std::vector<std::string> more) {
    const ProgramResult result = run(more);
    EXPECT_EQ(result.exit_code, 1);
    return result.err;
  };
  EXPECT_EQ(refusal({"--format", "mtx"}),
            "cleave export: --matrix: is required with --format mtx; choices: M, J, H, S\n");
  EXPECT_EQ(refusal({"--format", "mtx", "--matrix", "Q"}),
            "cleave export: --matrix: 'Q' is unknown; choices: M, J, H, S\n");
  EXPECT_EQ(refusal({"--format", "metis", "--matrix", "M"}),
            "cleave export: --matrix: --format metis writes none; leave it out\n");
  EXPECT_EQ(refusal({"--format", "mtx", "--matrix", "S"}),
            "cleave export: --partition: --matrix S is of one; name a label that the file stores\n");
  EXPECT_EQ(refusal({"--format", "mtx", "--matrix", "H", "--partition", "x"}),
            "cleave export: --partition: --matrix H is of none; leave it out\n");
}

}  // namespace
}  // namespace cleave
