#include "harness/files/csv_recorder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace cleave {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  throw std::runtime_error(path.string() + ": cannot be written: " + std::strerror(error));
}

}  // namespace

CsvRecorder::CsvRecorder(std::filesystem::path path, const std::string& header) : path_(std::move(path)) {
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file_ < 0) fail(path_, errno);
  append(header);
}

CsvRecorder::~CsvRecorder() { ::close(file_); }

// One write call for all lines. A short one happens only where the disk is full, and the next one says why; what
// was written is then taken back so that no half line stays behind.
void CsvRecorder::append(const std::string& lines) {
  if (lines.empty()) return;
  const off_t begin = ::lseek(file_, 0, SEEK_CUR);
  std::string_view left = lines;
  while (!left.empty()) {
    const ssize_t written = ::write(file_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) break;
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  if (left.empty()) return;
  const int error = errno;
  if (::ftruncate(file_, begin) == 0) ::lseek(file_, begin, SEEK_SET);
  fail(path_, error);
}

}  // namespace cleave
