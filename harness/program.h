// What every program of this project does: finds the command, parses its options, turns every error into one
// line on stderr and an exit code.
#pragma once

#include <span>
#include <string>

#include "harness/commands/command.h"

namespace cleave {

// Returns the exit code. name: what help and errors call the program. more: its commands besides commands().
int run_program(const std::string& name, std::span<const Command> more, int argc, char** argv);

}  // namespace cleave
