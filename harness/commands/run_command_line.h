// The command line of `run` and its kin, drawn from the option table and from the scenes' parameters.
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <string>

namespace cleave {

// Whether a command has an option of the table.
using HasOption = bool (*)(const std::string& name);

// Each option stores its text under its name in `given`, which must outlive the parsing; checks come later.
void declare_run_options(
    CLI::App& app, std::map<std::string, std::string>& given,
    HasOption has = [](const std::string&) { return true; });

// One option per parameter name of any scene.
void declare_scene_options(CLI::App& app, std::map<std::string, std::string>& given);

}  // namespace cleave
