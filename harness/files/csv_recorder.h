// Writes steps.csv so that whatever ends the program, the file holds complete lines only.
//
// The file has its final name from the start; the lines of one step go to the system in one write.
#pragma once

#include <filesystem>
#include <string>

namespace cleave {

class CsvRecorder {
 public:
  // Creates (or empties) the file and writes the header. Throws std::runtime_error naming the file and the
  // reason, here and in append().
  CsvRecorder(std::filesystem::path path, const std::string& header);
  ~CsvRecorder();
  CsvRecorder(const CsvRecorder&) = delete;
  CsvRecorder& operator=(const CsvRecorder&) = delete;

  // All lines of one step, each with its end.
  void append(const std::string& lines);

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace cleave
