#include "harness/base/algorithm.h"

#include <algorithm>
#include <stdexcept>

#include "harness/base/names.h"

namespace cleave {
namespace {

using Given = std::map<std::string, std::string>;

[[noreturn]] void reject(const std::string& option, const std::string& text) {
  throw std::invalid_argument(option + ": " + text);
}

// What follows each @.
std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t at = text.find('@'); at != std::string::npos;) {
    const std::size_t next = text.find('@', at + 1);
    parts.push_back(text.substr(at + 1, next == std::string::npos ? next : next - at - 1));
    at = next;
  }
  return parts;
}

Given read_given(const std::string& option, const std::string& text) {
  Given given;
  for (const std::string& part : parts_of(text)) {
    const std::size_t equals = part.find('=');
    if (equals == 0 || equals == std::string::npos)
      reject(option, "'" + text + "': write name@parameter=value, not '@" + part + "'");
    if (!given.emplace(part.substr(0, equals), part.substr(equals + 1)).second)
      reject(option, "'" + text + "': " + part.substr(0, equals) + " is given twice");
  }
  return given;
}

void check_known(const std::string& option, const std::string& text, const Given& given,
                 const std::vector<std::string>& names, const ParameterOwners& owners) {
  for (const auto& [name, value] : given) {
    if (std::ranges::find(names, name) != names.end()) continue;
    const std::string owner = owners(name);
    const std::string& algorithm = algorithm_name(text);
    const std::string has =
        "; " + algorithm + (names.empty() ? " has no parameters" : " has: " + joined(names));
    if (!owner.empty()) reject(option, "'" + text + "': " + name + " is a parameter of " + owner + has);
    reject(option, "'" + text + "': '" + name + "' is no parameter" + nearest_question(name, names) + has);
  }
}

// Whether a part of a text, "name=value", is of a parameter of this kind.
bool is_of_kind(const std::string& part, std::span<const Parameter> parameters, Parameter::Kind kind) {
  const auto row = std::ranges::find(parameters, part.substr(0, part.find('=')), &Parameter::name);
  return row != parameters.end() && row->kind == kind;
}

// The text with fingerprints where it names files whose content counts.
std::string known_text(const std::string& text, std::span<const Parameter> parameters, const Given& values) {
  std::string known = algorithm_name(text);
  for (const std::string& part : parts_of(text)) {
    const std::string name = part.substr(0, part.find('='));
    known +=
        "@" + (is_of_kind(part, parameters, Parameter::Kind::content) ? name + "=" + values.at(name) : part);
  }
  return known;
}

}  // namespace

bool has_parameter(const AlgorithmEntry& entry, const std::string& name) {
  return std::ranges::count(entry.parameters, name, &Parameter::name) > 0;
}

std::string unavailable_text(const AlgorithmEntry& entry) {
  return entry.unavailable.empty() ? "" : "is not in this build: " + entry.unavailable;
}

void check_available(const std::string& option, const AlgorithmEntry& entry) {
  if (!entry.unavailable.empty()) reject(option, entry.name + (" " + unavailable_text(entry)));
}

std::string reason_to_leave_out(const AlgorithmEntry& entry, const Given& common) {
  if (!entry.unavailable.empty()) return unavailable_text(entry);
  std::vector<std::string> missing;
  for (const Parameter& parameter : entry.parameters)
    if (parameter.default_value.empty() &&
        (parameter.kind == Parameter::Kind::path || !common.contains(parameter.name)))
      missing.push_back(parameter.name);
  return missing.empty() ? "" : "needs " + joined(missing);
}

std::string algorithm_name(const std::string& text) { return text.substr(0, text.find('@')); }

bool names_parameter(const std::string& text, const std::string& name) {
  return std::ranges::any_of(parts_of(text),
                             [&](const std::string& part) { return part.starts_with(name + "="); });
}

Algorithm read_algorithm(const std::string& option, const std::string& text,
                         std::span<const Parameter> parameters, const Given& common,
                         const ParameterOwners& owners) {
  const Given given = read_given(option, text);
  check_known(option, text, given, names_of(parameters), owners);
  const std::string name = algorithm_name(text);
  Given values;
  for (const Parameter& parameter : parameters) {
    const auto own = given.find(parameter.name), shared = common.find(parameter.name);
    if (own != given.end()) {
      const std::string place = option + " " + name + "@" + parameter.name;
      values[parameter.name] = checked_value(parameter, place, own->second);
    } else if (shared != common.end()) {
      values[parameter.name] = checked_value(parameter, "--" + parameter.name, shared->second);
    } else if (!parameter.default_value.empty()) {
      values[parameter.name] = default_of(parameter);
    } else {
      const std::string way = parameter.kind == Parameter::Kind::path ? "" : ", or --" + parameter.name;
      reject(option, name + " needs " + parameter.name + ": write " + name + "@" + parameter.name + "=" +
                         (parameter.kind == Parameter::Kind::path ? "FILE" : "VALUE") + way);
    }
  }
  std::string known = known_text(text, parameters, values);
  return {std::move(known), name, Settings(std::move(values))};
}

std::string text_with_content(const std::string& text, std::span<const Parameter> parameters,
                              const std::string& fingerprint) {
  std::string known = algorithm_name(text) + "@" + fingerprint;
  for (const std::string& part : parts_of(text))
    if (!is_of_kind(part, parameters, Parameter::Kind::path)) known += "@" + part;
  return known;
}

std::string fingerprint_of(const std::string& text) {
  const std::vector<std::string> parts = parts_of(text);
  return parts.empty() || parts.front().find('=') != std::string::npos ? "" : parts.front();
}

Settings defaults_of(const AlgorithmEntry& entry) {
  std::map<std::string, std::string> values;
  for (const Parameter& parameter : entry.parameters)
    if (!parameter.default_value.empty()) values[parameter.name] = default_of(parameter);
  return Settings(std::move(values));
}

}  // namespace cleave
