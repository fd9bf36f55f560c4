#include "scenarios/scene.h"

#include <charconv>
#include <cstdio>
#include <stdexcept>
#include <string_view>

namespace cleave {
namespace {

using Type = SceneParameter::Type;

template <typename Number>
std::errc parse(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end != text.data() + text.size()) return std::errc::invalid_argument;
  return error;
}

std::vector<std::string_view> split_at_commas(std::string_view text) {
  std::vector<std::string_view> items;
  for (std::size_t comma = text.find(','); comma != text.npos; comma = text.find(',')) {
    items.push_back(text.substr(0, comma));
    text.remove_prefix(comma + 1);
  }
  items.push_back(text);
  return items;
}

std::string option(std::string_view name) { return "--" + std::string(name); }

std::string range(const SceneParameter& parameter) {
  char text[64];
  std::snprintf(text, sizeof text, "[%.10g, %.10g]", parameter.min, parameter.max);
  return text;
}

[[noreturn]] void reject(const SceneParameter& parameter, std::string_view value, const std::string& rule) {
  throw std::invalid_argument(option(parameter.name) + ": " + std::string(value) + " is not " + rule);
}

std::string quoted(std::string_view text) { return std::string("'").append(text).append("'"); }

void check_integer(const SceneParameter& parameter, std::string_view text) {
  long long value = 0;
  const std::errc error = parse(text, value);
  if (error == std::errc::invalid_argument)
    reject(parameter, quoted(text), "a whole number in " + range(parameter));
  const bool inside =
      static_cast<double>(value) >= parameter.min && static_cast<double>(value) <= parameter.max;
  if (error != std::errc{} || !inside) reject(parameter, text, "in " + range(parameter));
}

void check_number(const SceneParameter& parameter, std::string_view text) {
  double value = 0;
  const std::errc error = parse(text, value);
  if (error == std::errc::invalid_argument)
    reject(parameter, quoted(text), "a number in " + range(parameter));
  // Written so that NaN falls outside.
  const bool inside = value >= parameter.min && value <= parameter.max;
  if (error != std::errc{} || !inside) reject(parameter, text, "in " + range(parameter));
}

void check_choice(const SceneParameter& parameter, std::string_view text) {
  std::string known;
  for (const std::string& choice : parameter.choices) {
    if (choice == text) return;
    known += (known.empty() ? "" : ", ") + choice;
  }
  reject(parameter, quoted(text), "one of " + known);
}

void check(const SceneParameter& parameter, std::string_view text) {
  switch (parameter.type) {
    case Type::integer:
      return check_integer(parameter, text);
    case Type::number:
      return check_number(parameter, text);
    case Type::number_list:
      for (const std::string_view item : split_at_commas(text)) check_number(parameter, item);
      return;
    case Type::choice:
      return check_choice(parameter, text);
    case Type::text:
      return;
  }
}

void check_known(const SceneEntry& scene, const std::string& name) {
  std::string known;
  for (const SceneParameter& parameter : scene.parameters) {
    if (parameter.name == name) return;
    known += (known.empty() ? "" : ", ") + option(parameter.name);
  }
  throw std::invalid_argument(option(name) + ": scene " + quoted(scene.name) +
                              " has no such option (it has: " + known + ")");
}

}  // namespace

int SceneSettings::integer(const std::string& name) const { return std::stoi(text(name)); }

double SceneSettings::number(const std::string& name) const {
  double value = 0;
  parse(text(name), value);
  return value;
}

std::vector<double> SceneSettings::numbers(const std::string& name) const {
  std::vector<double> values;
  for (const std::string_view item : split_at_commas(text(name))) parse(item, values.emplace_back());
  return values;
}

SceneSettings make_scene_settings(const SceneEntry& scene, const std::map<std::string, std::string>& given) {
  for (const auto& [name, value] : given) check_known(scene, name);
  std::map<std::string, std::string> values;
  for (const SceneParameter& parameter : scene.parameters) {
    const auto found = given.find(parameter.name);
    if (found == given.end() && parameter.default_value == nullptr)
      throw std::invalid_argument(option(parameter.name) + ": is required by scene " + quoted(scene.name) +
                                  ": " + parameter.help);
    const std::string& value = values[parameter.name] =
        found == given.end() ? parameter.default_value : found->second;
    check(parameter, value);
  }
  SceneSettings settings(std::move(values));
  scene_content_id(scene, settings);
  return settings;
}

std::string scene_content_id(const SceneEntry& scene, const SceneSettings& settings) {
  return scene.content_id == nullptr ? "" : scene.content_id(settings);
}

}  // namespace cleave
