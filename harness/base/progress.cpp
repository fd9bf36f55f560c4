#include "harness/base/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "harness/base/printable_text.h"

namespace cleave {
namespace {

constexpr char kSteps[] = "step %lld of %lld, %ld s, about %ld s to go";  // written and read

// Characters that fit on a line of the terminal before its last column; 0 where it does not say.
std::size_t terminal_room() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1u : 0;
}

}  // namespace

ProgressLine::ProgressLine(std::string label)
    : label_(std::move(label)), terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (terminal_ && shown_) std::fputc('\n', stderr);
}

bool ProgressLine::is_due() const { return Clock::now() - last_ >= std::chrono::seconds(terminal_ ? 1 : 10); }

void ProgressLine::update(long long done, long long total) {
  if (!is_due()) return;
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - begin_).count();
  const double left_s = elapsed_s / static_cast<double>(done) * static_cast<double>(total - done);
  char text[100];
  std::snprintf(text, sizeof text, kSteps, done, total, std::lround(elapsed_s), std::lround(left_s));
  show(text);
}

void ProgressLine::show(const std::string& text) {
  last_ = Clock::now();
  shown_ = true;
  std::string line = label_ + ": " + text;
  const std::size_t room = terminal_ ? terminal_room() : 0;
  if (room > 0) line = std::string(first_characters(line, room));
  const std::size_t width = count_characters(line);
  if (terminal_ && width < width_) line.append(width_ - width, ' ');  // over what stands there
  width_ = width;
  std::fprintf(stderr, "%s%s%s", terminal_ ? "\r" : "", line.c_str(), terminal_ ? "" : "\n");
  std::fflush(stderr);
}

std::optional<double> expected_seconds(const std::string& printed) {
  long long done = 0, total = 0;
  long elapsed_s = 0, left_s = 0;
  for (std::size_t end = printed.size(); end > 0;) {
    const std::size_t place = printed.rfind("step ", end - 1);
    if (place == std::string::npos) break;
    if (std::sscanf(printed.c_str() + place, kSteps, &done, &total, &elapsed_s, &left_s) == 4)
      return static_cast<double>(elapsed_s + left_s);
    end = place;
  }
  return std::nullopt;
}

}  // namespace cleave
