// A run once more, from its manifest alone, in a process of its own; its rows must be those that it left.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "harness/commands/check_list.h"

namespace cleave {

struct RepeatedRun {
  std::string program;              // this one
  std::filesystem::path directory;  // of the run that is repeated
  std::filesystem::path out;        // keeps the repeated run; empty: nothing does
  std::optional<int> threads;       // in place of those it had
  bool force = false;               // overwrite what `out` holds
};

// Adds one check: row by row, every column but the machine's. Returns false where the repeated run was interrupted; nothing is added then.
// Throws std::invalid_argument for a directory that holds no complete `cleave run`, std::runtime_error where the process failed.
bool check_repeated_run(const RepeatedRun& run, CheckList& list);

}  // namespace cleave
