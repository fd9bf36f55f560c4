#include "harness/experiment/repartition.h"

#include <stdexcept>
#include <vector>

#include "harness/base/names.h"
#include "harness/base/numbers.h"

namespace cleave {
namespace {

// In the order of Repartition::Kind.
const std::vector<std::string> kWords = {"always", "on-change", "every", "drift"};

}  // namespace

Repartition read_repartition(const std::string& option, const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string word = text.substr(0, colon);
  check_name(option, word, kWords);
  Repartition read{.text = text};
  while (kWords[static_cast<std::size_t>(read.kind)] != word)
    read.kind = static_cast<Repartition::Kind>(static_cast<int>(read.kind) + 1);
  const bool has_number = colon != std::string::npos;
  const bool wants_number = read.kind == Repartition::Kind::every || read.kind == Repartition::Kind::drift;
  if (has_number != wants_number)
    throw std::invalid_argument(
        option + ": '" + text +
        "' is none of always, on-change, every:K with K in [1, inf), drift:X with X in [0, inf)");
  if (!has_number) return read;
  const std::string number = text.substr(colon + 1), named = option + ": " + word;
  // What means the same is written alike, as it is in run ids.
  if (read.kind == Repartition::Kind::every) {
    read.steps = parse_integer(named, number, {.min = 1});
    read.text = word + ":" + std::to_string(read.steps);
  } else {
    read.drift = parse_number(named, number, {.min = 0});
    read.text = word + ":" + number_text(read.drift);
  }
  return read;
}

}  // namespace cleave
