#include "harness/base/progress.h"

#include <unistd.h>

#include <cstdio>

namespace cleave {

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
  std::snprintf(text, sizeof text, "step %d of %d, %.0f s, about %.0f s to go", done, total, elapsed_s,
                left_s);
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

}  // namespace cleave
