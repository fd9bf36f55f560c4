// What `cleave verify` finds out from one problem file alone.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/files/problem_file.h"

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

// The judge's numbers agree: equal up to the last digits, or both no numbers.
bool same_residual(double stored_m_per_s, double found_m_per_s);

// Index of the first id outside [0, n), or -1.
int find_bad_part_id(const std::vector<int>& part_of_body);

// Of the file: its friction model. Of every solution: its label, its residual judged anew against the stored
// one, its velocity against v0 + M^-1 J^T impulse. Of every partition: its label, its part ids, and the same
// parts when the stored partitioner and refiner split the problem again with the stored options.
void check_problem_file(const std::filesystem::path& path, const ProblemFile& file, CheckList& list);

}  // namespace cleave
