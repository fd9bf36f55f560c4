// A run once more, from its manifest and the files that it read, in a process of its own; its rows must be
// those that it left.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/commands/check_list.h"

namespace cleave {

struct RepeatedRun {
  std::string program;              // this one
  std::filesystem::path directory;  // of the run that is repeated
  std::filesystem::path out;        // keeps the repeated run; empty: nothing does
  std::optional<int> threads;       // in place of those it had
  bool force = false;               // overwrite what `out` holds
  std::map<std::string, std::string>
      files;  // options as they are given, "scene": "file@path=a.toml", that name files
};

// The options of a complete run that are not in `files` and have to be: the manifest knows of their files the
// content alone.
std::vector<std::string> missing_files(const RepeatedRun& run);

// Adds one check: row by row, every column but the machine's. Returns false where the repeated run was
// interrupted; nothing is added then. Throws std::invalid_argument for a directory that holds no complete
// `cleave run` and for a missing file, std::runtime_error where the process failed.
bool check_repeated_run(const RepeatedRun& run, CheckList& list);

}  // namespace cleave
