#include "harness/commands/run_command_line.h"

#include "harness/options.h"

namespace cleave {
namespace {

std::string default_text(const std::string& value) {
  return value.empty() || value == "nan" ? "" : " (" + value + ")";
}

}  // namespace

void declare_run_options(CLI::App& app, std::map<std::string, std::string>& given, HasOption has) {
  const RunOptions defaults = default_run_options();
  for (const OptionSpec& spec : run_option_specs()) {
    if (!has(spec.name)) continue;
    const std::string dashed = "--" + spec.name;
    if (spec.kind == OptionSpec::Kind::flag) {
      app.add_flag_callback(
          dashed, [&given, name = spec.name] { given[name] = "true"; }, spec.help);
      continue;
    }
    app.add_option_function<std::string>(
           dashed, [&given, name = spec.name](const std::string& text) { given[name] = text; },
           spec.help + default_text(spec.get(defaults)))
        ->type_name(spec.placeholder);
  }
}

void declare_scene_options(CLI::App& app, std::map<std::string, std::string>& given) {
  std::map<std::string, std::string> help;  // by name: several scenes may share a parameter
  for (const SceneEntry& scene : scenes()) {
    for (const SceneParameter& parameter : scene.parameters) {
      std::string& text = help[parameter.name];
      if (text.empty()) text = parameter.help;
      const char* const value = parameter.default_value == nullptr ? "required" : parameter.default_value;
      text += std::string("; ") + scene.name + " (" + value + ")";
    }
  }
  for (const auto& [name, text] : help) {
    app.add_option_function<std::string>(
           "--" + name, [&given, name = name](const std::string& value) { given[name] = value; }, text)
        ->type_name("X")
        ->group("Options of scenes");
  }
}

}  // namespace cleave
