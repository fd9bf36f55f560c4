// Writes steps.csv so that whatever ends the program, the file holds complete lines only.
//
// The file has its final name from the start; the lines of one step go to the system in one write.
#pragma once

#include <filesystem>
#include <span>

#include "harness/step_record.h"

namespace cleave {

class CsvRecorder {
 public:
  // Creates (or empties) the file and writes the header. Throws std::runtime_error naming the file and the
  // reason, here and in write().
  explicit CsvRecorder(std::filesystem::path path);
  ~CsvRecorder();
  CsvRecorder(const CsvRecorder&) = delete;
  CsvRecorder& operator=(const CsvRecorder&) = delete;

  // All rows of one step.
  void write(std::span<const StepRecord> rows);

 private:
  void append(const std::string& lines);
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace cleave
