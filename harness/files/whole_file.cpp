#include "harness/files/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "harness/base/write_all.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

// A descriptor that is closed whatever happens.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : value_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool is_open() const { return value_ >= 0; }
  bool write(std::string_view bytes) const { return write_all(value_, bytes); }
  // All bytes, as far as they can be read.
  std::string read() const {
    std::string bytes;
    char block[4096];
    ssize_t count;
    while ((count = ::read(value_, block, sizeof block)) > 0)
      bytes.append(block, static_cast<std::size_t>(count));
    return bytes;
  }
  bool seek(std::size_t place) const { return ::lseek(value_, static_cast<off_t>(place), SEEK_SET) >= 0; }
  // Pipes and some network disks cannot sync and say EINVAL; there is nothing more to ask of them.
  bool sync() const { return ::fsync(value_) == 0 || errno == EINVAL; }

 private:
  int value_;
};

[[noreturn]] void fail(const fs::path& path, int reason) {
  ::unlink(part_name_of(path).c_str());
  throw std::runtime_error(path.string() + ": cannot be written: " + std::strerror(reason));
}

void write_aside(const NamedBytes& named) {
  std::error_code ignored;
  if (fs::is_directory(named.path, ignored))
    fail(named.path, EISDIR);  // the renaming would find out too late
  const Descriptor file(part_name_of(named.path), O_WRONLY | O_CREAT | O_TRUNC);
  if (!file.is_open() || !file.write(named.bytes) || !file.sync()) fail(named.path, errno);
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

void rename_part(const fs::path& path) {
  if (::rename(part_name_of(path).c_str(), path.c_str()) != 0) fail(path, errno);
}

void sync_folder(const fs::path& path) {
  if (const Descriptor folder(folder_of(path), O_RDONLY | O_DIRECTORY); folder.is_open() && !folder.sync())
    fail(path, errno);
}

}  // namespace

fs::path part_name_of(const fs::path& path) { return path.string() + ".part"; }

void publish_part_file(const fs::path& path) {
  const fs::path part = part_name_of(path);
  if (const Descriptor file(part, O_RDONLY); !file.is_open() || !file.sync()) fail(path, errno);
  rename_part(path);
  sync_folder(path);
}

void write_whole_file(const fs::path& path, std::string_view bytes) {
  const NamedBytes named{path, bytes};
  write_whole_files({&named, 1});
}

void write_whole_files(std::span<const NamedBytes> files) {
  std::size_t aside = 0;
  try {
    for (; aside < files.size(); ++aside) write_aside(files[aside]);
    for (const NamedBytes& named : files)
      rename_part(named.path);  // at once: who is killed here leaves the rest aside
    for (const NamedBytes& named : files) sync_folder(named.path);
  } catch (...) {
    while (aside > 0) ::unlink(part_name_of(files[--aside].path).c_str());
    throw;
  }
}

GrowingFile::GrowingFile(const fs::path& path)
    : path_(path),
      descriptor_(::open(part_name_of(path).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail(path_, errno);
  std::error_code ignored;
  if (!fs::is_directory(path_, ignored)) return;
  ::close(descriptor_);
  fail(path_, EISDIR);  // the renaming would find out too late
}

GrowingFile::~GrowingFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!is_published_) ::unlink(part_name_of(path_).c_str());
}

void GrowingFile::write(std::string_view bytes) {
  constexpr std::size_t kBlock = 1 << 20;
  waiting_ += bytes;
  if (waiting_.size() >= kBlock) flush();
}

void GrowingFile::finish() {
  flush();
  ::close(std::exchange(descriptor_, -1));  // many may wait for each other
  sync_file(part_name_of(path_));
}

void GrowingFile::publish() {
  publish_part_file(path_);
  is_published_ = true;
}

void GrowingFile::flush() {
  if (!write_all(descriptor_, waiting_)) fail(path_, errno);
  waiting_.clear();
}

void sync_file(const fs::path& path) {
  if (const Descriptor file(path, O_RDONLY); !file.is_open() || !file.sync())
    throw std::runtime_error(path.string() + ": cannot be written: " + std::strerror(errno));
}

bool replace_in_place(const fs::path& path, std::string_view from, std::string_view to) {
  assert(from.size() == to.size());
  const Descriptor file(path, O_RDWR);
  const std::size_t place = file.is_open() ? file.read().find(from) : std::string::npos;
  return place != std::string::npos && file.seek(place) && file.write(to) && file.sync();
}

}  // namespace cleave
