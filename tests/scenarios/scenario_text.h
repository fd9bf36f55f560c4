// Option values for tests that run over every parameter of every scene.
#pragma once

#include <string>
#include <vector>

#include "harness/base/numbers.h"
#include "scenarios/scene.h"

namespace cleave {

inline std::vector<std::string> bad_values(const Parameter& parameter) {
  if (parameter.kind == Parameter::Kind::path)
    return {};  // what is wrong with a file is the scene's own matter
  std::vector<std::string> values = {"", " ", "nonsense", "1x", " 1", "nan", "inf", "-inf", "-1", "1e400"};
  if (parameter.kind == Parameter::Kind::word) return values;
  values.push_back(number_text(parameter.range.min - 1));
  values.push_back(number_text(parameter.range.max + 1));
  if (parameter.kind == Parameter::Kind::numbers) values.insert(values.end(), {"1,", ",1", "1,nan", "1;2"});
  return values;
}

// The ends of the range, or every choice.
inline std::vector<std::string> extreme_values(const Parameter& parameter) {
  if (parameter.kind == Parameter::Kind::path) return {};
  if (parameter.kind == Parameter::Kind::word) return parameter.words;
  const auto text = [&](double end) {
    return parameter.kind == Parameter::Kind::integer ? std::to_string(static_cast<long>(end))
                                                      : number_text(end);
  };
  return {text(parameter.range.min), text(parameter.range.max)};
}

}  // namespace cleave
