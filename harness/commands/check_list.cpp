#include "harness/commands/check_list.h"

#include <cstdio>

#include "harness/base/printable_text.h"

namespace cleave {

void CheckList::add(bool passed, const std::string& subject, const std::string& text) {
  ++checks_;
  failures_ += passed ? 0 : 1;
  std::printf("%s  %s\n", passed ? "ok  " : "FAIL", printable(subject + ": " + text).c_str());
}

void CheckList::note(const std::string& subject, const std::string& text) { say(subject + ": " + text); }

void Findings::add(const std::string& text) {
  if (++count_ <= kTold) told_ += "; " + text;
}

std::string Findings::text() const {
  return told_ + (count_ > kTold ? "; and " + std::to_string(count_ - kTold) + " more" : "");
}

}  // namespace cleave
