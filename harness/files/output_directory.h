// The directory of --out: checked before anything is created, created only when everything else is known to
// be good.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cleave {

// Throws std::invalid_argument with one line naming --out, the path and the reason: not a directory, not
// writable, or it already holds one of the files that will be written and `force` is false. Creates nothing.
void check_output_directory(const std::string& out, bool force,
                            const std::vector<std::string>& files = {"steps.csv"});

// Creates the directory and its parents; same errors.
std::filesystem::path create_output_directory(const std::string& out);

}  // namespace cleave
