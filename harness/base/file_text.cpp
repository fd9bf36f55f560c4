#include "harness/base/file_text.h"

#include <array>
#include <fstream>
#include <system_error>

namespace cleave {

std::optional<std::string> file_text(const std::filesystem::path& path) {
  std::error_code none;
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path, none)) return std::nullopt;
  std::string text;
  std::array<char, 65536> block;
  while (file.read(block.data(), block.size()), file.gcount() > 0)
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
  return file.bad() ? std::nullopt : std::optional(std::move(text));
}

}  // namespace cleave
