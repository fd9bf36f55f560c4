// The command line of `run` and its kin, drawn from the option table, from the parameters that algorithms
// declare and from the scenes' parameters.
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <string>

#include "harness/experiment/options.h"

namespace cleave {

// Declares what the command has: the table's options, parameters of algorithms and, with a world, of scenes.
// Each option stores its text under its name in `given`, which must outlive the parsing; checks come later.
void declare_run_options(CLI::App& app, std::map<std::string, std::string>& given, bool CommandSet::*command);

}  // namespace cleave
