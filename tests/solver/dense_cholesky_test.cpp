#include "solver/linear/dense_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstring>
#include <new>
#include <vector>

#include "solver/linear/dense_tiles.h"
#include "tests/solver/seeded_random.h"

namespace cleave {
namespace {

Eigen::MatrixXd random_positive(int size, int seed) {
  SeededRandom random(seed);
  Eigen::MatrixXd a(size, size);
  for (int c = 0; c < size; ++c) {
    for (int r = c; r < size; ++r) a(r, c) = a(c, r) = random.uniform(-1, 1);
    a(c, c) = 0.7 * size + 2;
  }
  return a;
}

void fill(DenseCholesky& cholesky, const Eigen::MatrixXd& a) {
  cholesky.resize(static_cast<int>(a.rows()));
  for (int p = 0; p < cholesky.panel_count(); ++p) cholesky.fill_panel(p, a);
}

std::vector<double> right_hand_side(int size) {
  std::vector<double> b(size);
  for (int i = 0; i < size; ++i) b[i] = std::sin(1 + i);
  return b;
}

// A^-1 b on so many threads.
std::vector<double> solved(const Eigen::MatrixXd& a, int threads) {
  StageClock clock;
  ParallelTasks tasks(clock, threads);
  DenseCholesky cholesky;
  fill(cholesky, a);
  EXPECT_TRUE(cholesky.factor(tasks));
  std::vector<double> x = right_hand_side(static_cast<int>(a.rows()));
  cholesky.solve(x);
  return x;
}

bool same_bytes(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), 8 * a.size()) == 0;
}

// Sizes around the edges of groups (8), panels (24) and blocks (120), and of several blocks.
constexpr int kSizes[] = {1, 2, 7, 8, 9, 23, 24, 25, 47, 49, 119, 120, 121, 144, 240, 241, 367, 500};

TEST(DenseCholeskyTest, SolvesAsEigenDoes) {
  for (const int size : kSizes) {
    const Eigen::MatrixXd a = random_positive(size, size);
    const std::vector<double> b = right_hand_side(size), x = solved(a, 1);
    const Eigen::VectorXd expected = a.llt().solve(Eigen::Map<const Eigen::VectorXd>(b.data(), size));
    for (int i = 0; i < size; ++i) EXPECT_NEAR(x[i], expected(i), 1e-13) << "size " << size << ", row " << i;
  }
}

TEST(DenseCholeskyTest, GivesTheSameBytesOnAnyNumberOfThreadsInAnyOrder) {
  for (const int size : kSizes) {
    const Eigen::MatrixXd a = random_positive(size, size);
    const std::vector<double> one = solved(a, 1);
    for (const int threads : {1, 2, 3, 5}) {
      for (const int seed : {0, 1, 2}) {
        WorkerTeam::shared(threads).shuffle(seed);
        EXPECT_TRUE(same_bytes(solved(a, threads), one))
            << "size " << size << ", " << threads << " threads, seed " << seed;
        WorkerTeam::shared(threads).shuffle(0);
      }
    }
  }
}

TEST(DenseCholeskyTest, GivesTheSameBytesOnEveryInstructionSet) {
  const DenseTiles& chosen = dense_tiles();
  for (const int size : {25, 121, 367}) {
    const Eigen::MatrixXd a = random_positive(size, size);
    const std::vector<double> expected = solved(a, 1);
    for (const DenseTiles* tiles : all_dense_tiles()) {
      if (!tiles->is_supported()) continue;
      use_dense_tiles(*tiles);
      EXPECT_TRUE(same_bytes(solved(a, 2), expected)) << "size " << size << ", " << tiles->name;
    }
    use_dense_tiles(chosen);
  }
}

TEST(DenseCholeskyTest, RefusesWhatIsNotPositive) {
  for (const int bad_row : {0, 7, 30, 130, 299}) {
    for (const double pivot : {-1.0, 0.0, std::nan("")}) {
      Eigen::MatrixXd a = Eigen::MatrixXd::Identity(300, 300);
      a(bad_row, bad_row) = pivot;
      for (const int threads : {1, 2}) {
        StageClock clock;
        ParallelTasks tasks(clock, threads);
        DenseCholesky cholesky;
        fill(cholesky, a);
        EXPECT_FALSE(cholesky.factor(tasks)) << "row " << bad_row << ", pivot " << pivot;
        fill(cholesky, Eigen::MatrixXd::Identity(300, 300));
        EXPECT_TRUE(cholesky.factor(tasks)) << "the next matrix";
      }
    }
  }
}

// A solver that found no memory is asked again.
TEST(DenseCholeskyTest, IsUsableAfterASizeThatHasNoMemory) {
  StageClock clock;
  ParallelTasks tasks(clock, 2);
  DenseCholesky cholesky;
  fill(cholesky, random_positive(300, 1));
  EXPECT_THROW(cholesky.resize(4'000'000), std::bad_alloc);
  const Eigen::MatrixXd a = random_positive(300, 2);
  fill(cholesky, a);
  ASSERT_TRUE(cholesky.factor(tasks));
  std::vector<double> x = right_hand_side(300);
  cholesky.solve(x);
  EXPECT_TRUE(same_bytes(x, solved(a, 1)));
}

TEST(DenseCholeskyTest, NothingHasNoRows) { EXPECT_TRUE(solved(Eigen::MatrixXd(0, 0), 2).empty()); }

}  // namespace
}  // namespace cleave
