#include "scenarios/file_values.h"

namespace cleave::scene_file {
namespace {

constexpr double kLeastLength = 1e-6;  // of a direction: less is a mistake

std::string three_numbers(const Range& range) { return "a list of three numbers in " + range.text(); }

}  // namespace

Number read_number(const Value& value, const Range& range) {
  Number number;
  if (!value.is_table()) {
    number.from = number.to = value.number(range);
    return number;
  }
  Table table = value.table({"from", "to", "one_of"});
  if (const auto choices = table.find("one_of")) {
    for (const Value& choice : choices->list("a list of numbers in " + range.text()))
      number.one_of.push_back(choice.number(range));
    if (number.one_of.empty()) choices->reject("an empty list is not a list of numbers in " + range.text());
    table.expect_all_read("beside one_of");
    return number;
  }
  number.from = table.at("from").number(range);
  const Value to = table.at("to");
  number.to = to.number(range);
  if (number.to < number.from) to.reject_value("at or above from = " + number_text(number.from));
  return number;
}

DrawnVector read_drawn_vector(const Value& value, const Range& range) {
  const std::vector<Value> parts = value.list(3, three_numbers(range));
  return {read_number(parts[0], range), read_number(parts[1], range), read_number(parts[2], range)};
}

std::array<double, 3> read_vector(const Value& value, const Range& range) {
  const std::vector<Value> parts = value.list(3, three_numbers(range));
  return {parts[0].number(range), parts[1].number(range), parts[2].number(range)};
}

std::array<double, 3> read_direction(const Value& value) {
  const std::array<double, 3> direction = read_vector(value, kAnyLength_m);
  const double square =
      direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2];
  if (square < kLeastLength * kLeastLength)
    value.reject("has no length; a direction is a list of three numbers, at least one of them not 0");
  return direction;
}

}  // namespace cleave::scene_file
