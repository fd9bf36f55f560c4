// The tiles of every instruction set that this processor has, against loops that are written out: not one bit
// may differ.
#include "solver/linear/dense_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "solver/linear/dense_panel.h"
#include "tests/solver/seeded_random.h"

namespace cleave {
namespace {

using Values = std::vector<double>;

Values random_values(SeededRandom& random, int count) {
  Values values(count);
  for (double& value : values) value = random.uniform(-1, 1);
  return values;
}

testing::AssertionResult same_bytes(const Values& found, const Values& expected) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (std::memcmp(&found[i], &expected[i], sizeof(double)) != 0) {
      return testing::AssertionFailure() << "entry " << i << ": " << found[i] << " is not " << expected[i];
    }
  }
  return testing::AssertionSuccess();
}

void slow_panel_product(int depth, const double* a, const double* b, double* c) {
  for (int j = 0; j < kPanelColumns; ++j) {
    for (int r = 0; r < kPanelRows; ++r) {
      double sum = 0;
      for (int k = 0; k < depth; ++k) sum = std::fma(a[r + kPanelRows * k], b[j + kPanelRows * k], sum);
      c[r + kPanelRows * j] -= sum;
    }
  }
}

void slow_panel_by_transpose(const double* w, int first_row, double* c) {
  for (int r = first_row; r < kPanelRows; ++r) {
    for (int j = kPanelColumns - 1; j >= 0; --j) {
      double sum = c[r] * w[j];
      for (int k = 1; k <= j; ++k) sum = std::fma(c[r + kPanelRows * k], w[j + kPanelRows * k], sum);
      c[r + kPanelRows * j] = sum;
    }
  }
}

void slow_panel_vector(int columns, const double* panel, const double* x, double* y) {
  for (int r = 0; r < kPanelRows; ++r) {
    double sum = 0;
    for (int c = 0; c < columns; ++c) sum = std::fma(panel[r + kPanelRows * c], x[c], sum);
    y[r] -= sum;
  }
}

// Eight partial sums of three products each, added in pairs four apart, two apart and next to each other.
void slow_panel_transpose(int columns, const double* panel, const double* y, double* x) {
  for (int c = 0; c < columns; ++c) {
    double part[8];
    for (int r = 0; r < 8; ++r) {
      const double* own = panel + kPanelRows * c + r;
      part[r] = std::fma(own[16], y[r + 16], std::fma(own[8], y[r + 8], own[0] * y[r]));
    }
    double four[4];
    for (int r = 0; r < 4; ++r) four[r] = part[r] + part[r + 4];
    x[c] -= (four[0] + four[2]) + (four[1] + four[3]);
  }
}

void slow_product(int rows, int depth, const double* a, int lda, const double* b, int ldb, double* c,
                  int ldc) {
  for (int j = 0; j < 6; ++j) {
    for (int r = 0; r < rows; ++r) {
      double sum = 0;
      for (int k = 0; k < depth; ++k) sum = std::fma(a[r + k * lda], b[j + k * ldb], sum);
      c[r + j * ldc] -= sum;
    }
  }
}

void slow_by_transpose(int rows, const double* w, double* c) {
  for (int r = 0; r < rows; ++r) {
    double in[6];
    for (int k = 0; k < 6; ++k) in[k] = c[r + k * rows];
    for (int j = 0; j < 6; ++j) {
      double sum = in[0] * w[j];
      for (int k = 1; k <= j; ++k) sum = std::fma(in[k], w[j + 6 * k], sum);
      c[r + j * rows] = sum;
    }
  }
}

void slow_gram(int rows, const double* jacobian, const double* d, double* h) {
  for (int column = 0; column < 12; ++column) {
    for (int row = 0; row < 12; ++row) {
      double sum = 0;
      for (int r = 0; r < rows; ++r) {
        if (d[r] == 0) continue;
        sum = std::fma(jacobian[12 * r + row] * d[r], jacobian[12 * r + column], sum);
      }
      h[row + 12 * column] = sum;
    }
  }
}

class DenseTilesTest : public testing::TestWithParam<const DenseTiles*> {
 protected:
  void SetUp() override {
    if (!GetParam()->is_supported()) skipped_ = true;
  }
  bool skipped_ = false;  // this processor cannot run them; the narrower set is still tested
};

TEST_P(DenseTilesTest, PanelLoopsGiveTheBytesOfWrittenOutLoops) {
  if (skipped_) return;
  const DenseTiles& tiles = *GetParam();
  SeededRandom random(7);
  for (const int depth : {0, 1, 7, 8, 24, 120}) {
    const Values a = random_values(random, kPanelRows * (depth + kPanelColumns)),
                 b = random_values(random, kPanelRows * (depth + kPanelColumns)),
                 x = random_values(random, depth + kPanelRows);
    Values found = random_values(random, kPanelRows * kPanelColumns), expected = found;
    tiles.subtract_panel_product(depth, a.data(), b.data() + 8, found.data());
    slow_panel_product(depth, a.data(), b.data() + 8, expected.data());
    EXPECT_TRUE(same_bytes(found, expected)) << "product of depth " << depth;
    for (const int first_row : {0, 8, 16, 24}) {
      tiles.multiply_panel_by_transpose(b.data(), first_row, found.data());
      slow_panel_by_transpose(b.data(), first_row, expected.data());
      EXPECT_TRUE(same_bytes(found, expected)) << "transposed from row " << first_row;
    }
    tiles.subtract_panel_vector(depth, a.data(), x.data(), found.data());
    slow_panel_vector(depth, a.data(), x.data(), expected.data());
    EXPECT_TRUE(same_bytes(found, expected)) << "matrix by vector, " << depth << " columns";
    Values found_x = x, expected_x = x;
    tiles.subtract_panel_transpose(depth, a.data(), b.data(), found_x.data());
    slow_panel_transpose(depth, a.data(), b.data(), expected_x.data());
    EXPECT_TRUE(same_bytes(found_x, expected_x)) << "transposed by vector, " << depth << " columns";
  }
}

TEST_P(DenseTilesTest, BlockProductsGiveTheBytesOfWrittenOutLoops) {
  if (skipped_) return;
  SeededRandom random(8);
  for (int rows = 2; rows <= 60; rows += 2) {
    const int ld = rows + 4, depth = 6 * (rows % 5);
    const Values a = random_values(random, ld * (depth + 1)), b = random_values(random, ld * (depth + 1) + 8);
    Values found = random_values(random, 6 * ld), expected = found;
    GetParam()->subtract_product(rows, depth, a.data(), ld, b.data(), ld, found.data(), ld);
    slow_product(rows, depth, a.data(), ld, b.data(), ld, expected.data(), ld);
    EXPECT_TRUE(same_bytes(found, expected)) << rows << " rows";
    // What is between the columns stays as it is.
    found = random_values(random, 6 * ld), expected = found;
    GetParam()->write_negative_product(rows, depth, a.data(), ld, b.data(), ld, found.data(), ld);
    for (int j = 0; j < 6; ++j) std::fill_n(expected.begin() + j * ld, rows, 0.0);
    slow_product(rows, depth, a.data(), ld, b.data(), ld, expected.data(), ld);
    EXPECT_TRUE(same_bytes(found, expected)) << rows << " rows from zero";
  }
}

TEST_P(DenseTilesTest, BlocksOfSixGiveTheBytesOfWrittenOutLoops) {
  if (skipped_) return;
  SeededRandom random(9);
  for (int rows = 2; rows <= 60; rows += 2) {
    const Values w = random_values(random, 36);
    Values found = random_values(random, 6 * rows), expected = found;
    GetParam()->multiply_by_transpose(rows, w.data(), 6, found.data(), rows);
    slow_by_transpose(rows, w.data(), expected.data());
    EXPECT_TRUE(same_bytes(found, expected)) << rows << " rows";
  }
}

TEST_P(DenseTilesTest, GramMatricesGiveTheBytesOfWrittenOutLoops) {
  if (skipped_) return;
  SeededRandom random(10);
  for (int rows = 1; rows <= 12; ++rows) {
    const Values jacobian = random_values(random, 12 * rows);
    Values d = random_values(random, rows), found(144), expected(144);
    if (rows > 2) d[rows / 2] = 0;
    ASSERT_TRUE(GetParam()->weighted_gram(2, rows, jacobian.data(), d.data(), found.data()));
    slow_gram(rows, jacobian.data(), d.data(), expected.data());
    for (int column = 0; column < 12; ++column) {
      for (int row = column < 6 ? 0 : 6; row < 12; ++row) {  // blocks on and below the diagonal
        EXPECT_EQ(found[row + 12 * column], expected[row + 12 * column])
            << rows << " rows, " << row << ", " << column;
      }
    }
    found = random_values(random, 144);
    ASSERT_TRUE(GetParam()->weighted_gram(1, rows, jacobian.data(), d.data(), found.data()));
    for (int column = 0; column < 6; ++column) {
      for (int row = 0; row < 6; ++row) {
        EXPECT_EQ(found[row + 12 * column], expected[row + 12 * column])
            << rows << " rows of one body, " << row << ", " << column;
      }
    }
    d.assign(rows, 0.0);
    for (const int bodies : {1, 2})
      EXPECT_FALSE(GetParam()->weighted_gram(bodies, rows, jacobian.data(), d.data(), found.data()));
  }
}

INSTANTIATE_TEST_SUITE_P(All, DenseTilesTest,
                         testing::ValuesIn(all_dense_tiles().begin(), all_dense_tiles().end()),
                         [](const auto& info) {
                           std::string name = info.param->name;
                           std::erase(name, '-');
                           return name;
                         });

TEST(DenseTilesChoiceTest, TakesTheWidestThatTheProcessorHas) {
  const DenseTiles* widest = nullptr;
  for (const DenseTiles* tiles : all_dense_tiles()) {
    if (widest == nullptr && tiles->is_supported()) widest = tiles;
  }
  EXPECT_EQ(&dense_tiles(), widest);
  EXPECT_TRUE(all_dense_tiles().back()->is_supported());
}

}  // namespace
}  // namespace cleave
