#include "harness/base/parameter.h"

#include <algorithm>
#include <stdexcept>

#include "harness/base/names.h"

namespace cleave {
namespace {

using Kind = Parameter::Kind;

std::string canonical_numbers(const Parameter& parameter, const std::string& option,
                              const std::string& text) {
  std::vector<std::string> words;
  for (const std::string& item : split_list(text))
    words.push_back(number_text(parse_number(option, item, parameter.range)));
  return joined(words, ",");
}

std::string checked_flag(const std::string& option, const std::string& text) {
  if (text == "true" || text == "1") return "true";
  if (text == "false" || text == "0") return "false";
  throw std::invalid_argument(option + ": '" + text + "' is not one of true, false");
}

}  // namespace

std::string column_of(std::string name) {
  std::ranges::replace(name, '-', '_');
  return name;
}

std::string default_of(const Parameter& parameter) {
  return parameter.default_value.empty() ? ""
                                         : checked_value(parameter, parameter.name, parameter.default_value);
}

std::string allowed_text(const Parameter& parameter) {
  switch (parameter.kind) {
    case Kind::integer:
    case Kind::number:
    case Kind::numbers:
      return parameter.range.text();
    case Kind::word:
      return joined(parameter.words, "|");
    case Kind::flag:
      return "true|false";
    case Kind::path:
    case Kind::content:
      return "a file";
  }
  return "";
}

std::string checked_value(const Parameter& parameter, const std::string& option, const std::string& text) {
  switch (parameter.kind) {
    case Kind::integer:
      return std::to_string(parse_integer(option, text, parameter.range));
    case Kind::number:
      return number_text(parse_number(option, text, parameter.range));
    case Kind::numbers:
      return canonical_numbers(parameter, option, text);
    case Kind::word:
      check_name(option, text, parameter.words);
      return text;
    case Kind::flag:
      return checked_flag(option, text);
    case Kind::path:
      if (text.empty()) throw std::invalid_argument(option + ": needs the name of a file");
      return text;
    case Kind::content:
      return parameter.read_content(option, text);
  }
  return text;
}

int Settings::integer(const std::string& name) const { return parse_integer(name, text(name), Range{}); }

double Settings::number(const std::string& name) const { return parse_number(name, text(name), Range{}); }

std::vector<double> Settings::numbers(const std::string& name) const {
  std::vector<double> values;
  for (const std::string& item : split_list(text(name))) values.push_back(parse_number(name, item, Range{}));
  return values;
}

std::size_t Settings::word_index(const Parameter& parameter) const {
  const auto found = std::ranges::find(parameter.words, text(parameter.name));
  if (found == parameter.words.end())
    throw std::logic_error(parameter.name + " is '" + text(parameter.name) + "', not one of " +
                           joined(parameter.words));
  return static_cast<std::size_t>(found - parameter.words.begin());
}

}  // namespace cleave
