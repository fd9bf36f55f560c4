#include "harness/base/progress.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace cleave {
namespace {

constexpr char kSteps[] = "step %d of %d, %ld s, about %ld s to go";  // written and read

}  // namespace

ProgressLine::ProgressLine(std::string label)
    : label_(std::move(label)), terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (terminal_ && shown_) std::fputc('\n', stderr);
}

bool ProgressLine::is_due() const { return Clock::now() - last_ >= std::chrono::seconds(terminal_ ? 1 : 10); }

void ProgressLine::update(int done, int total) {
  if (!is_due()) return;
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - begin_).count();
  const double left_s = elapsed_s / done * (total - done);
  char text[100];
  std::snprintf(text, sizeof text, kSteps, done, total, std::lround(elapsed_s), std::lround(left_s));
  show(text);
}

void ProgressLine::show(const std::string& text) {
  last_ = Clock::now();
  shown_ = true;
  std::string line = label_ + ": " + text;
  const std::size_t width = line.size();
  if (terminal_ && width < width_) line.append(width_ - width, ' ');  // over what stands there
  width_ = width;
  std::fprintf(stderr, "%s%s%s", terminal_ ? "\r" : "", line.c_str(), terminal_ ? "" : "\n");
  std::fflush(stderr);
}

std::optional<double> expected_seconds(const std::string& printed) {
  int done = 0, total = 0;
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
