// Changes a command line as its writer would: by options and values that there are, and some that there
// nearly are.
#include <map>
#include <set>
#include <sstream>
#include <vector>

#include "harness/base/names.h"
#include "harness/experiment/options.h"
#include "tests/fuzz/target.h"

namespace cleave::fuzz {
namespace {

using Texts = std::vector<std::string>;

const std::string& one_of(const Texts& texts, Random& random) { return texts[random() % texts.size()]; }

const Texts kNumbers = {
    "0",     "1",      "-1",    "2",          "nan",        "inf",  "-inf",
    "1e308", "1e-320", "1e400", "2147483647", "2147483648", "0x10", "18446744073709551615",
    "1,2",   "1e-9",   "0.5",   "100",        "10,100,1000"};
const Texts kFlags = {"true", "false"};

// An option or a parameter, and values that are of its kind; none where they are not known.
using Values = std::map<std::string, Texts>;

Texts values_of(const Parameter& parameter) {
  if (parameter.kind == Parameter::Kind::flag) return kFlags;
  return parameter.kind == Parameter::Kind::word ? parameter.words : kNumbers;
}

Texts values_of(const OptionSpec& spec) {
  if (spec.kind == OptionKind::number) return kNumbers;
  if (spec.kind == OptionKind::flag) return kFlags;
  for (const AlgorithmKind& kind : algorithm_kinds())
    if (kind.option == (spec.name == "advance" ? "solver" : spec.name)) return kind.names;
  return spec.name == "mode" ? Texts{"lockstep", "separate"} : Texts{};
}

Values all_parameters() {
  Values values;
  for (const AlgorithmKind& kind : algorithm_kinds())
    for (const AlgorithmEntry& entry : kind.entries)
      for (const Parameter& parameter : entry.parameters) values[parameter.name] = values_of(parameter);
  return values;
}

Values all_options() {
  Values values = all_parameters();
  for (const OptionSpec& spec : run_option_specs()) values[spec.name] = values_of(spec);
  return values;
}

Texts all_words() {
  std::set<std::string> words = {"", " ", "all", "paper", ",", "a@b=c", "@", "-"};
  for (const auto& [option, values] : all_options()) words.insert(values.begin(), values.end());
  return Texts(words.begin(), words.end());
}

Texts names_in(const Values& values) {
  Texts names;
  for (const auto& [name, of_its_kind] : values) names.push_back(name);
  return names;
}

// Of the option's kind in three of four draws: other values seldom get past its reader.
const std::string& draw_word(const std::string& option, Random& random) {
  static const Texts words = all_words();
  static const Values values = all_options();
  const auto found = values.find(option);
  const bool is_of_kind = found != values.end() && !found->second.empty() && random() % 4 != 0;
  return one_of(is_of_kind ? found->second : words, random);
}

// In every other draw one word; else name@parameter=value, and lists of these.
std::string draw_value(const std::string& option, Random& random) {
  static const Texts parameters = names_in(all_parameters());
  std::string value = draw_word(option, random);
  if (random() % 2 == 0) return value;
  while (random() % 3 == 0) {
    const std::string& parameter = one_of(parameters, random);
    value += "@" + parameter + "=" + draw_word(parameter, random);
  }
  return random() % 4 == 0 ? value + "," + draw_value(option, random) : value;
}

// As an argument, or as an option that a manifest holds.
std::string draw_line(Random& random) {
  static const Texts options = names_in(all_options());
  const std::string& option = one_of(options, random);
  const std::string line = (random() % 3 == 0 ? "= " : "--") + option;
  return random() % 8 == 0 ? line : line + "=" + draw_value(option, random);
}

std::string with_other_value(const std::string& line, Random& random) {
  const std::string start = line.substr(0, line.find('=', 2));
  return start + "=" + draw_value(start.size() > 2 ? start.substr(2) : "", random);
}

Texts lines_of(const std::string& bytes) {
  std::istringstream text(bytes);
  Texts lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

}  // namespace

std::string mutate_options(const std::string& bytes, Random& random) {
  Texts lines = lines_of(bytes);
  if (lines.empty()) lines = {"run", "--scene=rock_pile", "--out=o"};
  const std::size_t place = random() % lines.size();
  switch (random() % 4) {
    case 0:
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(place));
      break;
    case 1:
      lines[place] = with_other_value(lines[place], random);
      break;
    default:
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(place) + 1, draw_line(random));
  }
  return joined(lines, "\n");
}

}  // namespace cleave::fuzz
