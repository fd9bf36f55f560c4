// Changes a command line as its writer would: by options and values that there are, and some that there nearly are.
#include <sstream>
#include <vector>

#include "harness/base/names.h"
#include "harness/experiment/options.h"
#include "tests/fuzz/target.h"

namespace cleave::fuzz {
namespace {

using Texts = std::vector<std::string>;

const std::string& one_of(const Texts& texts, Random& random) { return texts[random() % texts.size()]; }

Texts all_parameters() {
  Texts names;
  for (const AlgorithmKind& kind : algorithm_kinds())
    for (const AlgorithmEntry& entry : kind.entries)
      for (const Parameter& parameter : entry.parameters) names.push_back(parameter.name);
  return names;
}

Texts all_words() {
  Texts words = {"0",     "1",        "-1",       "2",     "nan",         "inf",
                 "-inf",  "1e308",    "1e-320",   "1e400", "2147483647",  "2147483648",
                 "0x10",  "true",     "false",    "",      " ",           "all",
                 "paper", "lockstep", "separate", "1,2",   "10,100,1000", "18446744073709551615",
                 ",",     "a@b=c",    "@",        "-",     "1e-9",        "0.5",
                 "100"};
  for (const AlgorithmKind& kind : algorithm_kinds()) {
    words.insert(words.end(), kind.names.begin(), kind.names.end());
    for (const AlgorithmEntry& entry : kind.entries)
      for (const Parameter& parameter : entry.parameters)
        words.insert(words.end(), parameter.words.begin(), parameter.words.end());
  }
  return words;
}

Texts all_options() {
  Texts names = all_parameters();
  for (const OptionSpec& spec : run_option_specs()) names.push_back(spec.name);
  return names;
}

// name, name@parameter=value, and lists of these.
std::string draw_value(Random& random) {
  static const Texts words = all_words(), parameters = all_parameters();
  std::string value = one_of(words, random);
  while (random() % 3 == 0) value += "@" + one_of(parameters, random) + "=" + one_of(words, random);
  return random() % 4 == 0 ? value + "," + draw_value(random) : value;
}

// As an argument, or as an option that a manifest holds.
std::string draw_line(Random& random) {
  static const Texts options = all_options();
  const std::string line = (random() % 3 == 0 ? "= " : "--") + one_of(options, random);
  return random() % 8 == 0 ? line : line + "=" + draw_value(random);
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
      lines[place] = lines[place].substr(0, lines[place].find('=', 2)) + "=" + draw_value(random);
      break;
    default:
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(place) + 1, draw_line(random));
  }
  return joined(lines, "\n");
}

}  // namespace cleave::fuzz
