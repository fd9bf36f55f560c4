// What the checks of `cleave verify` and `cleave rerun` come to.
#pragma once

#include <string>

namespace cleave {

// Prints every check as one line on stdout, "ok    subject: text" or "FAIL  subject: text", and counts them.
class CheckList {
 public:
  void add(bool passed, const std::string& subject, const std::string& text);
  // What is read and cannot be wrong: told on stderr, not counted.
  static void note(const std::string& subject, const std::string& text);
  int checks() const { return checks_; }
  int failures() const { return failures_; }

 private:
  int checks_ = 0;
  int failures_ = 0;
};

// What is wrong in the rows of a table: the first few in words, the others counted.
class Findings {
 public:
  void add(const std::string& text);
  bool none() const { return count_ == 0; }
  std::string text() const;  // begins with "; " where there is any

 private:
  static constexpr int kTold = 5;
  int count_ = 0;
  std::string told_;
};

}  // namespace cleave
