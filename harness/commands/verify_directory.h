// What `cleave verify` finds out about an output directory as a whole.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/commands/check_list.h"

namespace cleave {

// First that all files are there and as they were written: where one is not, nothing in the directory is
// looked at any further. Then that the run has ended, and what problem files, manifest and rows say.
void verify_directory(const std::filesystem::path& directory, CheckList& list);

// Whether the files of a directory are those that `checksums` names, as it has them, and `required` is among
// them. besides: names of what it may hold too.
bool check_files(const std::filesystem::path& directory, const std::vector<std::string>& required,
                 const std::vector<std::string>& besides, CheckList& list);

// All names in it, sorted.
std::vector<std::string> names_in(const std::filesystem::path& directory);

}  // namespace cleave
