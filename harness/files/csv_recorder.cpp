#include "harness/files/csv_recorder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "harness/base/write_all.h"

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

// What was written before the disk was full is taken back, so that no half line stays behind.
void CsvRecorder::append(const std::string& lines) {
  if (lines.empty()) return;
  const off_t begin = ::lseek(file_, 0, SEEK_CUR);
  if (write_all(file_, lines)) return;
  const int error = errno;
  if (::ftruncate(file_, begin) == 0) ::lseek(file_, begin, SEEK_SET);
  fail(path_, error);
}

}  // namespace cleave
