// The command line of `run` and its kin, drawn from the option table, from the parameters that algorithms
// declare and from the scenes' parameters.
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <string>
#include <vector>

#include "harness/experiment/repeated_options.h"

namespace cleave {

// Declares what the command has: the table's options, parameters of algorithms and, with a world, of scenes.
// Each option stores its text under its name in `given`, which must outlive the parsing; checks come later.
// --config is kept there too, until with_config reads it.
void declare_run_options(CLI::App& app, std::map<std::string, std::string>& given, bool CommandSet::*command);

// The given options and, with --config FILE among them, those of the manifest FILE, which `name` must have
// written. own: options that the command declares itself.
RepeatedOptions with_config(std::map<std::string, std::string> given, const std::string& name,
                            bool CommandSet::*command, const std::vector<std::string>& own = {});

}  // namespace cleave
