// Numbers as text: to a value with the one form of error line, and back. Everything a user writes is read
// here.
#pragma once

#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>
#include <vector>

namespace cleave {

// An interval of allowed values; an infinite end is open by itself.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;
  bool max_open = false;

  bool contains(double value) const;  // false for NaN and infinities
  std::string text() const;           // "[0, inf)"
};

// option: what an error begins with. Throw std::invalid_argument: "--mu: -1 is not in [0, inf)", "--mu: 'x'
// is not a number in [0, inf)".
double parse_number(const std::string& option, const std::string& text, const Range& range);
int parse_integer(const std::string& option, const std::string& text, const Range& range);
std::uint64_t parse_seed(const std::string& option, const std::string& text);

// Reads a text that is one number; "nan" and "inf" are floating-point ones. std::errc::invalid_argument for
// any other text, result_out_of_range for a number that does not fit.
template <class Number>
std::errc error_of_whole(const std::string& text, Number& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop != end ? std::errc::invalid_argument : error;
}

template <class Number>
bool read_whole(const std::string& text, Number& value) {
  return error_of_whole(text, value) == std::errc{};
}

// "a,b,c" to its items.
std::vector<std::string> split_list(const std::string& text);

// "100,200,300" in ascending order, each number in the range and none repeated; and back.
std::vector<int> parse_integers(const std::string& option, const std::string& text, const Range& range);
std::string joined_numbers(const std::vector<int>& numbers);

// Shortest text that reads back as the same number; "nan" and "inf" as such.
std::string number_text(double value);

}  // namespace cleave
