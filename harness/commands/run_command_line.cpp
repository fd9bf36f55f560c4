#include "harness/commands/run_command_line.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <vector>

#include "harness/base/names.h"
#include "harness/base/refusals.h"
#include "harness/files/manifest_reader.h"

namespace cleave {
namespace {

using Given = std::map<std::string, std::string>;

constexpr const char* kExample =
    "A parameter of one algorithm alone is written behind its name, so that several settings run side by "
    "side on\n"
    "the same problems:\n"
    "  --partitioner mindp@max-bodies=25,mindp@max-bodies=50 --solver pgs@sweeps=30,pgs@sweeps=300,schur\n"
    "As an option of its own (--max-bodies 30) it holds for all algorithms of the run that have it.";

std::string default_text(const std::string& value) {
  return value.empty() || value == "nan" ? "" : " (" + value + ")";
}

CLI::Option* declare(CLI::App& app, Given& given, const std::string& name, const std::string& placeholder,
                     const std::string& help) {
  return app
      .add_option_function<std::string>(
          "--" + name, [&given, name](const std::string& text) { given[name] = text; }, help)
      ->type_name(placeholder);
}

CLI::Option* declare_flag(CLI::App& app, Given& given, const std::string& name, const std::string& help) {
  return app.add_flag_callback(
      "--" + name, [&given, name] { given[name] = "true"; }, help);
}

void declare_table(CLI::App& app, Given& given, bool CommandSet::*command) {
  const RunOptions defaults = default_run_options();
  for (const OptionSpec& spec : run_option_specs()) {
    if (!(spec.commands.*command)) continue;
    if (spec.kind == OptionKind::flag) {
      declare_flag(app, given, spec.name, spec.help);
    } else {
      declare(app, given, spec.name, spec.placeholder, spec.help + default_text(spec.get(defaults)));
    }
  }
}

std::string placeholder_of(const Parameter& parameter) {
  switch (parameter.kind) {
    case Parameter::Kind::integer:
      return "N";
    case Parameter::Kind::word:
      return joined(parameter.words, "|");
    case Parameter::Kind::content:
      return "FILE";
    default:
      return "X";
  }
}

bool is_number(const Parameter& parameter) {
  return parameter.kind == Parameter::Kind::integer || parameter.kind == Parameter::Kind::number;
}

void declare_parameters(CLI::App& app, Given& given, bool CommandSet::*command) {
  for (const auto& [parameter, owners, about, in_replay] : common_parameters()) {
    if (!has_world(command) && !in_replay) continue;
    const std::string range = is_number(parameter) ? ", in " + allowed_text(parameter) : "";
    const std::string help =
        parameter.help + range + default_text(parameter.default_value) + "; of " + owners;
    CLI::Option* option = parameter.kind == Parameter::Kind::flag
                              ? declare_flag(app, given, parameter.name, help)
                              : declare(app, given, parameter.name, placeholder_of(parameter), help);
    option->group("Parameters of algorithms");
  }
}

// What a parameter is, and the scenes of which it is that, with their defaults.
struct SceneHelp {
  std::string what, scenes;
};

// Scenes may share a parameter, and what it is of them may differ.
void add_help(const Parameter& parameter, const std::string& scene, std::vector<SceneHelp>& help) {
  auto same = std::ranges::find(help, parameter.help, &SceneHelp::what);
  if (same == help.end()) same = help.insert(help.end(), {parameter.help, ""});
  same->scenes += "; " + scene + " (" + parameter.default_value + ")";
}

// One option per parameter name of any scene.
void declare_scenes(CLI::App& app, Given& given) {
  std::map<std::string, std::vector<SceneHelp>> help;  // by name
  for (const SceneEntry& scene : scenes())
    for (const Parameter& parameter : scene.parameters)
      if (parameter.kind != Parameter::Kind::path) add_help(parameter, scene.name, help[parameter.name]);
  for (const auto& [name, kinds] : help) {
    std::vector<std::string> texts;
    for (const SceneHelp& kind : kinds) texts.push_back(kind.what + kind.scenes);
    declare(app, given, name, "X", joined(texts, "; or "))->group("Options of scenes");
  }
}

}  // namespace

void declare_run_options(CLI::App& app, Given& given, bool CommandSet::*command) {
  declare(
      app, given, "config", "FILE",
      "manifest.json whose run is repeated; options given beside it win, --out and --force are not in it");
  declare_table(app, given, command);
  declare_parameters(app, given, command);
  if (has_world(command)) declare_scenes(app, given);
  app.footer(kExample);
}

RepeatedOptions with_config(Given given, const std::string& name, bool CommandSet::*command,
                            const std::vector<std::string>& own) {
  const auto config = given.extract("config");
  if (config.empty()) return {given, {}};
  return in_context("--config", [&] {
    return repeated_options(read_manifest_options(config.mapped(), name), given, command, own);
  });
}

}  // namespace cleave
