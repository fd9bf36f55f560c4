// What an algorithm lets its users choose, declared in the algorithm's registry row and nowhere else: command
// line, --help, checks, the columns of steps.csv, run ids, attributes of problem files and the manifest are
// all drawn from these lists.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/base/numbers.h"

namespace cleave {

struct Parameter {
  // numbers: several, "10,100,1000". path: a file whose content counts and whose name does not. content: of
  // such a file the value is the fingerprint itself, so that it is a word like others once it was read.
  enum class Kind { integer, number, numbers, word, flag, path, content };

  std::string name;  // as in name@parameter=value: "max-bodies"; rows that share a name share the declaration
  Kind kind = Kind::number;
  std::string default_value = {};       // as text; empty: it must be given
  Range range = {};                     // of numbers
  std::vector<std::string> words = {};  // of a word, in the order of the enumeration they stand for
  std::string unit = {};                // empty: a pure number, or none
  std::string help = {};                // one line
  std::string source = {};              // where it is described or its default was measured; may be empty
  // Of content: reads what a text names and returns the fingerprint; a fingerprint stays as it is. option:
  // what errors begin with.
  std::string (*read_content)(const std::string& option, const std::string& text) = nullptr;
};

// "max_bodies" of "max-bodies": its column in steps.csv and its attribute in problem files.
std::string column_of(std::string name);

// The default in its one form of writing; empty where there is none.
std::string default_of(const Parameter& parameter);

// What may be given: "[1, inf)", "pairs|constraints|rows", "true|false".
std::string allowed_text(const Parameter& parameter);

// The value in its one form of writing ("1e1" is "10"). Throws std::invalid_argument beginning with `option`,
// naming the value and what is allowed.
std::string checked_value(const Parameter& parameter, const std::string& option, const std::string& text);

// Checked values by parameter name.
class Settings {
 public:
  Settings() = default;
  explicit Settings(std::map<std::string, std::string> values) : values_(std::move(values)) {}

  bool has(const std::string& name) const { return values_.contains(name); }
  const std::string& text(const std::string& name) const { return values_.at(name); }
  int integer(const std::string& name) const;
  double number(const std::string& name) const;
  std::vector<double> numbers(const std::string& name) const;
  bool flag(const std::string& name) const { return text(name) == "true"; }
  // The enumeration value that the word stands for. words: of the parameter.
  template <class Enum>
  Enum word(const Parameter& parameter) const {
    return static_cast<Enum>(word_index(parameter));
  }
  const std::map<std::string, std::string>& values() const { return values_; }

  bool operator==(const Settings&) const = default;

 private:
  std::size_t word_index(const Parameter& parameter) const;
  std::map<std::string, std::string> values_;
};

}  // namespace cleave
