// Reads manifest.json back, so that it can be given to the command that wrote it.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace cleave {

// The options that the manifest holds, by name, as a command line would give them: numbers in their one form
// of writing, truth values "true" or "false", a list one item a line. What is null or empty was not given and
// is left out. Throws std::invalid_argument with one line naming the file and what is wrong: not there, no
// JSON, another schema, another command than `command`, an option of no such form.
std::map<std::string, std::string> read_manifest_options(const std::filesystem::path& path,
                                                         const std::string& command);

}  // namespace cleave
