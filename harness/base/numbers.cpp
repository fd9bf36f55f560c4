#include "harness/base/numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "harness/base/names.h"

namespace cleave {
namespace {

[[noreturn]] void reject(const std::string& option, const std::string& value, const std::string& rule) {
  throw std::invalid_argument(option + ": " + value + " " + rule);
}

std::string quoted(const std::string& text) { return "'" + text + "'"; }

// A whole number as one writes it: 200000, not 2e+05.
std::string end_text(double end) {
  const bool is_count = end == std::floor(end) && std::abs(end) < 1e6;
  return is_count ? std::to_string(static_cast<int>(end)) : number_text(end);
}

}  // namespace

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> items(1);
  for (const char c : text) {
    if (c == ',') {
      items.emplace_back();
    } else {
      items.back() += c;
    }
  }
  return items;
}

bool Range::contains(double value) const {
  return std::isfinite(value) && (min_open ? value > min : value >= min) &&
         (max_open ? value < max : value <= max);
}

std::string Range::text() const {
  std::string text = min_open || std::isinf(min) ? "(" : "[";
  text += end_text(min) + ", " + end_text(max);
  return text + (max_open || std::isinf(max) ? ")" : "]");
}

double parse_number(const std::string& option, const std::string& text, const Range& range) {
  double value = 0;
  const std::errc error = error_of_whole(text, value);
  if (error == std::errc::invalid_argument)
    reject(option, quoted(text), "is not a number in " + range.text());
  if (error != std::errc{} || !range.contains(value)) reject(option, text, "is not in " + range.text());
  return value;
}

int parse_integer(const std::string& option, const std::string& text, const Range& range) {
  constexpr int kLeast = std::numeric_limits<int>::min(), kMost = std::numeric_limits<int>::max();
  long long value = 0;
  const std::errc error = error_of_whole(text, value);
  if (error == std::errc::invalid_argument)
    reject(option, quoted(text), "is not a whole number in " + range.text());
  if (error != std::errc{} || value < kLeast || value > kMost) {
    Range of_integers = range;
    of_integers.min = std::max<double>(range.min, kLeast);
    of_integers.max = std::min<double>(range.max, kMost);
    reject(option, text, "is not in " + of_integers.text());
  }
  if (!range.contains(static_cast<double>(value))) reject(option, text, "is not in " + range.text());
  return static_cast<int>(value);
}

std::uint64_t parse_seed(const std::string& option, const std::string& text) {
  std::uint64_t value = 0;
  if (!read_whole(text, value)) reject(option, quoted(text), "is not a whole number in [0, 2^64)");
  return value;
}

std::vector<int> parse_integers(const std::string& option, const std::string& text, const Range& range) {
  std::vector<int> numbers;
  for (const std::string& item : split_list(text)) numbers.push_back(parse_integer(option, item, range));
  std::ranges::sort(numbers);
  const auto repeated = std::ranges::adjacent_find(numbers);
  if (repeated != numbers.end()) reject(option, std::to_string(*repeated), "is given twice");
  return numbers;
}

std::string joined_numbers(const std::vector<int>& numbers) {
  std::vector<std::string> words;
  for (const int number : numbers) words.push_back(std::to_string(number));
  return joined(words, ",");
}

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

}  // namespace cleave
