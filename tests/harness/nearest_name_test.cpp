#include "harness/base/names.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace cleave {
namespace {

// Straight from the definition: the recursion on the last characters, without a table.
int slow_edit_distance(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return static_cast<int>(a.size() + b.size());
  const std::string_view a1 = a.substr(0, a.size() - 1), b1 = b.substr(0, b.size() - 1);
  int best = std::min({slow_edit_distance(a1, b) + 1, slow_edit_distance(a, b1) + 1,
                       slow_edit_distance(a1, b1) + (a.back() == b.back() ? 0 : 1)});
  if (a.size() > 1 && b.size() > 1 && a.back() == b1.back() && a1.back() == b.back())
    best = std::min(best, slow_edit_distance(a1.substr(0, a1.size() - 1), b1.substr(0, b1.size() - 1)) + 1);
  return best;
}

TEST(EditDistance, CountsEachEditOnce) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("mindp", "mindp"), 0);
  EXPECT_EQ(edit_distance("mindp", "mindq"), 1);
  EXPECT_EQ(edit_distance("mindp", "midnp"), 1);  // a swap of neighbours is one edit
  EXPECT_EQ(edit_distance("mindp", "mind"), 1);
  EXPECT_EQ(edit_distance("", "bfs"), 3);
  EXPECT_EQ(edit_distance("mindp", "maxdp"), 2);
}

TEST(EditDistance, AgreesWithTheRecursionOnRandomWords) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    std::mt19937_64 random(seed);
    const auto word = [&random] {
      std::string text(random() % 6, ' ');
      for (char& c : text) c = static_cast<char>('a' + random() % 3);
      return text;
    };
    const std::string a = word(), b = word();
    EXPECT_EQ(edit_distance(a, b), slow_edit_distance(a, b)) << "seed " << seed << ": " << a << " " << b;
    EXPECT_EQ(edit_distance(a, b), edit_distance(b, a)) << "seed " << seed;
  }
}

TEST(NearestName, FindsTheNearestAndFirstOnTies) {
  const std::vector<std::string> choices = {"mindp", "maxdp", "bfs", "mr", "mix"};
  EXPECT_EQ(nearest_name("mindq", choices), "mindp");
  EXPECT_EQ(nearest_name("bsf", choices), "bfs");
  EXPECT_EQ(nearest_name("mi", choices), "mr");  // one edit, as mix, and first in the list
  EXPECT_EQ(nearest_name("MAXDP", choices), "");
  EXPECT_EQ(nearest_name("gibberish", choices), "");
  EXPECT_EQ(nearest_name("", choices), "");
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(NearestName, CompletesACutOffName) {
  const std::vector<std::string> choices = {"pivot:dense", "interior-point:schur-rows"};
  EXPECT_EQ(nearest_name("interior", choices), "interior-point:schur-rows");
}

TEST(UnknownNameText, AsksAndLists) {
  const std::vector<std::string> choices = {"mindp", "maxdp"};
  EXPECT_EQ(unknown_name_text("mindq", choices),
            "'mindq' is unknown (did you mean 'mindp'?); choices: mindp, maxdp");
  EXPECT_EQ(unknown_name_text("zzzzz", choices), "'zzzzz' is unknown; choices: mindp, maxdp");
}

}  // namespace
}  // namespace cleave
