// Bytes under a file name, for readers that take a path; scripts/fuzz puts it into memory. An unnamed file
// that /proc/self/fd names would not do: the HDF5 library asks where that link leads, and opens nothing.
#pragma once

#include <fstream>
#include <string_view>

#include "tests/fuzz/scratch_folder.h"

namespace cleave::fuzz {

class ScratchFile {
 public:
  explicit ScratchFile(std::string_view bytes) : path_(next_path()) {
    if (!(std::ofstream(path_, std::ios::binary) << bytes))
      throw std::logic_error(path_.string() + ": cannot be written");
  }
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  static std::filesystem::path next_path() {
    static const ScratchFolder folder;
    static int count = 0;
    return folder.path() / std::to_string(++count);
  }
  std::filesystem::path path_;
};

}  // namespace cleave::fuzz
