#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace cleave {

// All bytes of a file; nothing where it cannot be read, or is a directory.
std::optional<std::string> file_text(const std::filesystem::path& path);

}  // namespace cleave
