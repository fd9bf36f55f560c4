#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace cleave {

// A file appears under its name only when it is whole and on the disk: it is written aside under
// `part_name_of`, synced and renamed, and the renaming is synced too. What stood there before stays until
// then.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

// Files that belong together: all are written aside before the first appears.
struct NamedBytes {
  std::filesystem::path path;
  std::string_view bytes;
};
void write_whole_files(std::span<const NamedBytes> files);

// A file that is written piece by piece, because it does not fit into memory: it lies aside until publish(),
// and is removed where that is not called.
class GrowingFile {
 public:
  explicit GrowingFile(const std::filesystem::path& path);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  void write(std::string_view bytes);
  void finish();   // no more is written: all is on the disk, under part_name_of(path)
  void publish();  // after finish()

 private:
  void flush();

  std::filesystem::path path_;
  std::string waiting_;
  int descriptor_;
  bool is_published_ = false;
};

// Where a file lies until it is whole: `path` with ".part".
std::filesystem::path part_name_of(const std::filesystem::path& path);

// For a writer that fills the file aside by itself: syncs it and gives it its name.
void publish_part_file(const std::filesystem::path& path);

// A file that was written otherwise: on the disk when this returns.
void sync_file(const std::filesystem::path& path);

// Where the disk is full: puts `to` in the place of the first `from` of a file, of the same length, in bytes
// that the file has already. False where it cannot.
bool replace_in_place(const std::filesystem::path& path, std::string_view from, std::string_view to);

// All others throw std::runtime_error "PATH: cannot be written: REASON" and leave no part file behind.
}  // namespace cleave
