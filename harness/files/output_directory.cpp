#include "harness/files/output_directory.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace cleave {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void reject(const std::string& out, const std::string& reason) {
  throw std::invalid_argument("--out: '" + out + "' " + reason);
}

// The longest part of the path that exists already.
fs::path nearest_existing(fs::path path) {
  std::error_code error;
  while (!fs::exists(path, error) && path.has_parent_path() && path != path.parent_path())
    path = path.parent_path();
  return path;
}

}  // namespace

void check_output_directory(const std::string& out, bool force, const std::vector<std::string>& files) {
  if (out.empty()) reject(out, "is not a directory name");
  std::error_code error;
  const fs::path path = fs::absolute(out);
  const fs::path existing = nearest_existing(path);
  if (!fs::is_directory(existing, error))
    reject(out, "cannot be a directory: " + existing.string() + " is none");
  if (::access(existing.c_str(), W_OK | X_OK) != 0)
    reject(out, "is not a writable directory: " + existing.string() + ": " + std::strerror(errno));
  for (const std::string& file : files) {
    if (!force && fs::exists(path / file, error))
      reject(out, "already holds " + file + "; name another directory, or overwrite it with --force");
  }
}

std::filesystem::path create_output_directory(const std::string& out) {
  std::error_code error;
  fs::create_directories(out, error);
  if (error) reject(out, "cannot be created: " + error.message());
  return out;
}

}  // namespace cleave
