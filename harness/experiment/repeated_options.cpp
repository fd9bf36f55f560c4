#include "harness/experiment/repeated_options.h"

#include <algorithm>
#include <initializer_list>
#include <stdexcept>

#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "partition/calibration.h"

namespace cleave {
namespace {

using Given = std::map<std::string, std::string>;

std::string value_of(const Given& given, const std::string& name) {
  const auto found = given.find(name);
  return found == given.end() ? "" : found->second;
}

bool any_of(const Given& given, std::initializer_list<const char*> names) {
  return std::ranges::any_of(names, [&](const char* name) { return given.contains(name); });
}

void drop(Given& stored, std::initializer_list<const char*> names) {
  for (const char* name : names) stored.erase(name);
}

std::vector<std::string> scene_parameters(const Given& stored) {
  const std::string scene = value_of(stored, "scene");
  if (scene.empty()) return {};
  check_algorithm("scene", scene);
  const std::vector<Parameter> parameters = parameters_of("scene", algorithm_name(scene));
  return names_of(std::span<const Parameter>(parameters));
}

[[noreturn]] void reject_unknown(const std::string& name, std::vector<std::string> known) {
  for (const OptionSpec& spec : run_option_specs()) known.push_back(spec.name);
  for (const CommonParameter& common : common_parameters()) known.push_back(common.parameter.name);
  throw std::invalid_argument("option '" + name + "' is unknown" + nearest_question(name, known));
}

// The first item of an option's list that carries a content's hash, as file@0123456789abcdef: what a manifest
// knows is not where it lay. Empty: there is none.
std::string item_of_file(const Given& options, const std::string& option) {
  for (const std::string& item : split_list(value_of(options, option)))
    if (!fingerprint_of(item).empty()) return item;
  return {};
}

void check_can_be_found(const Given& taken) {
  for (const char* option : kOptionsOfFiles)
    if (const std::string item = item_of_file(taken, option); !item.empty())
      throw std::invalid_argument("option " + std::string(option) + ": " + item +
                                  " is known by its content, not by its file; give --" + option +
                                  " beside --config");
}

// A manifest names every option of the table; the command takes those it declares. A flag is given or not.
bool is_taken(const std::string& name, const std::string& value, bool CommandSet::*command,
              const std::vector<std::string>& own_and_scene) {
  if (const OptionSpec* spec = find_option(name))
    return spec->commands.*command && name != "out" && name != "force" &&
           !(spec->kind == OptionKind::flag && value == "false");
  if (std::ranges::count(own_and_scene, name) > 0) return true;
  if (const CommonParameter* common = find_common_parameter(name))
    return has_world(command) || common->in_replay;
  reject_unknown(name, own_and_scene);
}

void drop_replaced(const Given& given, Given& stored) {
  if (any_of(given, {"erp", "cfm"})) drop(stored, {"stiffness", "damping"});
  if (any_of(given, {"stiffness", "damping"}) || any_of(stored, {"stiffness", "damping"}))
    drop(stored, {"erp", "cfm"});
  if (given.contains("solver")) drop(stored, {"strategy", "kernel"});
  if (any_of(given, {"partitioner", "refiner"})) drop(stored, {"objective"});
  if (given.contains("session")) drop(stored, {"repeats"});
  if (value_of(given.contains("mode") ? given : stored, "mode") == "separate")
    drop(stored, {"advance", "record-motion", "explain-model"});
}

bool is_another_scene(const Given& given, const Given& stored) {
  return given.contains("scene") &&
         algorithm_name(given.at("scene")) != algorithm_name(value_of(stored, "scene"));
}

}  // namespace

std::vector<std::string> options_of_files(const Given& stored) {
  std::vector<std::string> options;
  for (const char* option : kOptionsOfFiles)
    if (!item_of_file(stored, option).empty()) options.emplace_back(option);
  const std::string calibration = value_of(stored, "calibration");
  if (!calibration.empty() && !is_known_calibration(calibration)) options.emplace_back("calibration");
  return options;
}

RepeatedOptions repeated_options(const Given& stored, const Given& given, bool CommandSet::*command,
                                 const std::vector<std::string>& own) {
  const std::vector<std::string> of_scene = scene_parameters(stored);
  std::vector<std::string> own_and_scene = own;
  own_and_scene.insert(own_and_scene.end(), of_scene.begin(), of_scene.end());
  Given taken;
  for (const auto& [name, value] : stored)
    if (std::ranges::count(own, name) > 0 || is_taken(name, value, command, own_and_scene))
      taken.emplace(name, value);
  if (is_another_scene(given, taken))
    for (const std::string& name : of_scene)
      if (find_common_parameter(name) == nullptr) taken.erase(name);
  drop_replaced(given, taken);

  RepeatedOptions options{given, {}};
  for (const auto& [name, value] : taken)
    if (options.given.emplace(name, value).second) options.stored.insert(name);
  for (const auto& [name, value] : given) taken.erase(name);
  check_can_be_found(taken);
  return options;
}

}  // namespace cleave
