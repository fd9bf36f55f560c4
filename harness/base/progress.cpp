#include "harness/base/progress.h"

#include <unistd.h>

#include <cstdio>

namespace cleave {

ProgressLine::ProgressLine(std::string label)
    : label_(std::move(label)), terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (terminal_ && shown_) std::fputc('\n', stderr);
}

void ProgressLine::update(int done, int total) {
  const Clock::time_point now = Clock::now();
  const std::chrono::seconds interval(terminal_ ? 1 : 10);
  if (now - last_ < interval) return;
  last_ = now;
  shown_ = true;
  const double elapsed_s = std::chrono::duration<double>(now - begin_).count();
  const double left_s = elapsed_s / done * (total - done);
  std::fprintf(stderr, "%s%s: step %d of %d, %.0f s, about %.0f s to go%s", terminal_ ? "\r" : "",
               label_.c_str(), done, total, elapsed_s, left_s, terminal_ ? "   " : "\n");
  std::fflush(stderr);
}

}  // namespace cleave
