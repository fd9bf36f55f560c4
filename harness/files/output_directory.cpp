#include "harness/files/output_directory.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "harness/files/directory_lock.h"
#include "harness/files/manifest.h"
#include "harness/files/manifest_reader.h"
#include "harness/files/whole_file.h"

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
  check_not_locked(out);
  check_files_absent(out, force, files);
}

void check_files_absent(const std::string& out, bool force, const std::vector<std::string>& files) {
  std::error_code error;
  for (const std::string& file : files) {
    if (!force && fs::exists(fs::path(out) / file, error))
      reject(out, "already holds " + file + "; name another directory, or overwrite it with --force");
  }
}

std::filesystem::path create_output_directory(const std::string& out) {
  std::error_code error;
  fs::create_directories(out, error);
  if (error) reject(out, "cannot be created: " + error.message());
  return out;
}

std::vector<fs::path> files_of_earlier_work(const fs::path& directory) {
  std::vector<std::string> names;
  try {
    const StoredManifest manifest = read_manifest(directory / kManifestFile);
    // An older program did not say; of its files only this one was ever taken away.
    names = manifest.files.empty() ? std::vector<std::string>{kMotionFile} : manifest.files;
  } catch (const std::invalid_argument&) {
    // None, or damaged: nothing is known, so nothing is deleted, and verify names what is left.
  }
  std::vector<fs::path> files;
  for (const fs::path name : names)
    if (!name.empty() && name == name.filename() && name != "." && name != "..")
      files.push_back(directory / name);
  return files;
}

void remove_earlier_work(const fs::path& directory) {
  const auto remove = [](const fs::path& file) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw std::runtime_error(file.string() + ": cannot be deleted: " + error.message());
  };
  for (const fs::path& file : files_of_earlier_work(directory)) {
    remove(part_name_of(file));
    if (file.filename() != kManifestFile) remove(file);
  }
  remove(directory / kManifestFile);
}

}  // namespace cleave
