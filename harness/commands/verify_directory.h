// What `cleave verify` finds out about an output directory as a whole.
#pragma once

#include <filesystem>

#include "harness/commands/verify_checks.h"

namespace cleave {

// First that all files are there and as they were written: where one is not, nothing in the directory is looked at
// any further. Then that the run has ended, and what problem files, manifest and rows say.
void verify_directory(const std::filesystem::path& directory, CheckList& list);

}  // namespace cleave
