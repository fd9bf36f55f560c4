// The directory of --out: checked before anything is created, created only when everything else is known to
// be good.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cleave {

// Throws std::invalid_argument with one line naming --out, the path and the reason: not a directory, not
// writable, a running process writes into it, or it already holds one of the files that will be written and
// `force` is false. Creates nothing.
void check_output_directory(const std::string& out, bool force, const std::vector<std::string>& files);

// The last of these alone.
void check_files_absent(const std::string& out, bool force, const std::vector<std::string>& files);

// Creates the directory and its parents; same errors.
std::filesystem::path create_output_directory(const std::string& out);

// What an earlier command may have left there, by the manifest it left; none where that does not say.
std::vector<std::filesystem::path> files_of_earlier_work(const std::filesystem::path& directory);

// Deletes them, with what was not finished of them: --force. The manifest goes last, so that what is still
// there is known whenever this ends. Throws std::runtime_error naming the file and the reason.
void remove_earlier_work(const std::filesystem::path& directory);

}  // namespace cleave
