// Lemke's pivots on bare linear complementarity problems: what they end with is checked against the
// definition.
#include "solver/baselines/lemke_tableau.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "harness/base/stop.h"
#include "tests/solver/seeded_random.h"

namespace cleave {
namespace {

struct Lcp {
  int n;
  std::vector<double> m, q;  // (n, n) row-major, (n)
};

struct Ended {
  LemkeTableau::End end;
  std::vector<double> z, w;  // w = M z + q
  int pivots;
};

Ended run_lemke(const Lcp& lcp, int most_pivots = 10000) {
  LemkeTableau tableau;
  tableau.resize(lcp.n);
  for (int i = 0; i < lcp.n; ++i) {
    tableau.set_constant(i, lcp.q[i]);
    for (int j = 0; j < lcp.n; ++j) tableau.set_matrix(i, j, lcp.m[i * lcp.n + j]);
  }
  Ended ended{tableau.solve(most_pivots), std::vector<double>(lcp.n), lcp.q, tableau.pivots()};
  for (int j = 0; j < lcp.n; ++j) ended.z[j] = tableau.value(j);
  for (int i = 0; i < lcp.n; ++i)
    for (int j = 0; j < lcp.n; ++j) ended.w[i] += lcp.m[i * lcp.n + j] * ended.z[j];
  return ended;
}

void expect_solved(const Lcp& lcp, const Ended& ended, double tolerance) {
  ASSERT_EQ(ended.end, LemkeTableau::End::solved) << ended.pivots << " pivots";
  for (int i = 0; i < lcp.n; ++i) {
    EXPECT_GE(ended.z[i], 0);
    EXPECT_GE(ended.w[i], -tolerance);
    EXPECT_LE(std::min(ended.z[i], ended.w[i]), tolerance);
  }
}

// M = B B^T + skew, B of integers and of less than full rank as often as not; q = s - M z with whole s, z >=
// 0, of which many are zero: solvable, and full of ties.
Lcp make_degenerate(std::uint64_t seed) {
  SeededRandom random(seed);
  const int n = random.integer(1, 12), rank = random.integer(1, n);
  std::vector<double> b(n * rank);
  for (double& entry : b) entry = random.integer(-1, 1);
  Lcp lcp{n, std::vector<double>(n * n), std::vector<double>(n)};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < rank; ++k) lcp.m[i * n + j] += b[i * rank + k] * b[j * rank + k];
  if (random.chance(0.5)) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < i; ++j) {
        const int skew = random.integer(-1, 1);
        lcp.m[i * n + j] += skew;
        lcp.m[j * n + i] -= skew;
      }
  }
  std::vector<double> z(n);
  for (double& entry : z) entry = std::max(0, random.integer(-2, 2));
  for (int i = 0; i < n; ++i) {
    lcp.q[i] = std::max(0, random.integer(-2, 2));
    for (int j = 0; j < n; ++j) lcp.q[i] -= lcp.m[i * n + j] * z[j];
  }
  return lcp;
}

TEST(LemkeTableauTest, DegenerateSemidefiniteProblemsAreSolved) {
  for (int seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Lcp lcp = make_degenerate(seed);
    expect_solved(lcp, run_lemke(lcp, 500), 1e-8);
  }
}

// Kostreva, Cycling in linear complementarity problems, Mathematical Programming 16, 1979: all rows tie at
// once, and a careless choice among them cycles.
TEST(LemkeTableauTest, KostrevasProblemDoesNotCycle) {
  const Lcp lcp{3, {1, 2, 0, 0, 1, 2, 2, 0, 1}, {-1, -1, -1}};
  const Ended ended = run_lemke(lcp, 100);
  expect_solved(lcp, ended, 1e-12);
  for (const double z : ended.z) EXPECT_NEAR(z, 1.0 / 3, 1e-12);
}

// Murty, Computational complexity of complementary pivot methods, Mathematical Programming Study 7, 1978,
// with M lower triangular, and Fathi, Mathematical Programming 17, 1979, with the symmetric M = L L^T of all
// ties: 2^n pivots each.
TEST(LemkeTableauTest, MurtysAndFathisProblemsTakeAsManyPivotsAsProven) {
  for (int n = 2; n <= 8; ++n) {
    Lcp murty{n, std::vector<double>(n * n), std::vector<double>(n)}, fathi = murty;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j <= i; ++j) murty.m[i * n + j] = i == j ? 1 : 2;
      for (int j = n - i; j <= n; ++j) murty.q[i] -= std::ldexp(1.0, j);
    }
    for (int i = 0; i < n; ++i) {
      fathi.q[i] = -1;
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) fathi.m[i * n + j] += murty.m[i * n + k] * murty.m[j * n + k];
    }
    for (const Lcp& lcp : {murty, fathi}) {
      const Ended ended = run_lemke(lcp);
      expect_solved(lcp, ended, 1e-9);
      EXPECT_EQ(ended.pivots, 1 << n);
    }
  }
}

TEST(LemkeTableauTest, WhatHasNoSolutionEndsOnARay) {
  EXPECT_EQ(run_lemke({1, {0}, {-1}}).end, LemkeTableau::End::ray);
  // z1 = z2 + 1 and z2 = z1 + 1.
  EXPECT_EQ(run_lemke({2, {1, -1, -1, 1}, {-1, -1}}).end, LemkeTableau::End::ray);
  EXPECT_EQ(run_lemke({2, {1, -1, -1, 1}, {-1, 1}}).end, LemkeTableau::End::solved);
}

TEST(LemkeTableauTest, NothingNegativeNeedsNoPivot) {
  EXPECT_EQ(run_lemke({0, {}, {}}).end, LemkeTableau::End::solved);
  const Ended ended = run_lemke({2, {1, 0, 0, 1}, {0, 3}});
  EXPECT_EQ(ended.end, LemkeTableau::End::solved);
  EXPECT_EQ(ended.pivots, 0);
  EXPECT_EQ(ended.z, (std::vector<double>{0, 0}));
}

TEST(LemkeTableauTest, TheLimitOfPivotsIsAnEnd) {
  const Lcp lcp = {3, {1, 2, 0, 0, 1, 2, 2, 0, 1}, {-1, -1, -1}};
  const int needed = run_lemke(lcp).pivots;
  ASSERT_GT(needed, 1);
  EXPECT_EQ(run_lemke(lcp, needed).end, LemkeTableau::End::solved);
  const Ended early = run_lemke(lcp, needed - 1);
  EXPECT_EQ(early.end, LemkeTableau::End::pivot_limit);
  EXPECT_EQ(early.pivots, needed - 1);
}

TEST(LemkeTableauTest, IsStoppedBetweenPivotsAndSolvesAgain) {
  LemkeTableau tableau;
  std::atomic<bool> stop = true;
  for (const bool stopped : {true, false}) {
    stop = stopped;
    tableau.resize(1);
    tableau.set_matrix(0, 0, 2);
    tableau.set_constant(0, -3);
    if (stopped) {
      EXPECT_THROW(tableau.solve(10, &stop), Stopped);
    } else {
      EXPECT_EQ(tableau.solve(10, &stop), LemkeTableau::End::solved);
      EXPECT_EQ(tableau.value(0), 1.5);
    }
  }
}

}  // namespace
}  // namespace cleave
