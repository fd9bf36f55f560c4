#include "tests/fuzz/options_roundtrip.h"
#include "harness/experiment/option_values.h"

#include <algorithm>

#include "harness/experiment/repeated_options.h"
#include "tests/fuzz/target.h"

namespace cleave::fuzz {
namespace {

using Given = std::map<std::string, std::string>;

RunOptions parse(bool CommandSet::*command, const Given& stored, const Given& given) {
  const RepeatedOptions all = repeated_options(stored, given, command, {});
  return command == &CommandSet::replay ? parse_solve_options(all.given, all.stored)
                                        : parse_run_options(all.given, all.stored);
}

bool in_replay(const std::string& name) {
  if (const OptionSpec* spec = find_option(name)) return spec->commands.replay;
  const CommonParameter* common = find_common_parameter(name);
  return common != nullptr && common->in_replay;
}

// As the manifest of the command gives them back.
Given texts_of(bool CommandSet::*command, const std::vector<OptionValue>& values) {
  Given texts;
  for (const OptionValue& value : values)
    if (!value.text.empty() && value.text != "nan" &&
        (command != &CommandSet::replay || in_replay(value.name)))
      texts[value.name] = value.text;
  return texts;
}

bool is_of_a_file(const RunOptions& options) {
  const auto named = [](const Algorithm& algorithm) { return !fingerprint_of(algorithm.text).empty(); };
  return named(options.scene) || std::ranges::any_of(options.partitioners, named) ||
         std::ranges::any_of(options.refiners, named) || std::ranges::any_of(options.solvers, named);
}

}  // namespace

void check_options(bool CommandSet::*command, const Given& stored, const Given& given) {
  RunOptions options;
  if (refuses([&] { options = parse(command, stored, given); })) return;
  named_algorithms(options);
  const std::vector<OptionValue> values = option_values(options);
  if (is_of_a_file(options)) return;
  RunOptions again;
  std::string reason;
  const bool refused = refuses(
      [&] {
        again = parse(command, texts_of(command, values), {{"out", options.out}});
      },
      &reason);
  require(!refused, "the options of an accepted run are refused: " + reason);
  require(run_id(again) == run_id(values), "the options of an accepted run are another run");
}

}  // namespace cleave::fuzz
