// Option values for tests that run over every parameter of every scene.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "scenarios/scene.h"
#include "shipped_scenes.h"

namespace cleave {

inline std::string number_text(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

inline std::vector<std::string> bad_values(const SceneParameter& parameter) {
  if (parameter.type == SceneParameter::Type::text) return {"", " ", "no/such/file", "/"};
  std::vector<std::string> values = {"", " ", "nonsense", "1x", " 1", "nan", "inf", "-inf", "-1", "1e400"};
  if (parameter.type == SceneParameter::Type::choice) return values;
  values.push_back(number_text(parameter.min - 1));
  values.push_back(number_text(parameter.max + 1));
  if (parameter.type == SceneParameter::Type::number_list)
    values.insert(values.end(), {"1,", ",1", "1,nan", "1;2"});
  return values;
}

// The ends of the range, or every choice, or a file that is there.
inline std::vector<std::string> extreme_values(const SceneParameter& parameter) {
  if (parameter.type == SceneParameter::Type::text) return {shipped_file("pile")};
  if (parameter.type == SceneParameter::Type::choice) return parameter.choices;
  return {number_text(parameter.min), number_text(parameter.max)};
}

}  // namespace cleave
