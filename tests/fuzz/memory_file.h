// Bytes under a file name without a disk, for readers that take a path.
#pragma once

#include <filesystem>
#include <string_view>

namespace cleave::fuzz {

class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes);  // throws std::logic_error where the system gives none
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::filesystem::path path() const;

 private:
  int file_;
};

}  // namespace cleave::fuzz
