// cleave_peers siconos-error FILES: what Siconos says of solutions that are stored in problem files.
#pragma once

#include "harness/commands/command.h"

namespace cleave {

std::function<int()> declare_siconos_error(CLI::App& app, const std::vector<std::string>& argv);

}  // namespace cleave
