// Faults that are there on purpose: each has to end the program with the exit code of a finding.
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <vector>

namespace cleave {
namespace {

// Values that the compiler does not know.
template <class Number>
Number unknown(Number value) {
  volatile Number hidden = value;
  return hidden;
}

template <class Number>
void use(Number value) {
  [[maybe_unused]] volatile Number sink = value;
}

void read_past_the_end() {
  const auto numbers = std::make_unique<int[]>(3);
  use(numbers[unknown(3)]);
}

void read_past_the_size() {  // within what is reserved
  std::vector<int> numbers(3);
  numbers.reserve(100);
  use(numbers[unknown(3)]);
}

void read_after_delete() {
  auto number = std::make_unique<int>(1);
  const int* const left = number.get();
  number.reset();
  use(*left);
}

void add_one_to_the_largest() { use(unknown(std::numeric_limits<int>::max()) + 1); }
void turn_a_large_number_into_int() { use(static_cast<int>(unknown(1e10))); }

constexpr int kFinding = 66;

TEST(PlantedFaultDeathTest, EndsTheProgram) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto finding = ::testing::ExitedWithCode(kFinding);
  EXPECT_EXIT(read_past_the_end(), finding, "heap-buffer-overflow");
  EXPECT_EXIT(read_past_the_size(), ::testing::KilledBySignal(SIGABRT), "Assertion '__n < this->size\\(\\)'");
  EXPECT_EXIT(read_after_delete(), finding, "heap-use-after-free");
  EXPECT_EXIT(add_one_to_the_largest(), finding, "signed integer overflow");
  EXPECT_EXIT(turn_a_large_number_into_int(), finding, "outside the range of representable values");
}

}  // namespace
}  // namespace cleave
