// Runs the cleave program as a user does, and reads the files it leaves.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace cleave {

// Of a command line.
using Arguments = std::vector<std::string>;
inline Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// A fresh directory that is removed with everything in it.
class TemporaryDirectory {
 public:
  TemporaryDirectory();
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct ProgramResult {
  int exit_code = -1;  // 128 + signal where one ended it
  std::string out;
  std::string err;
};

// program: an absolute path. Waits for the end.
ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments);
ProgramResult run_cleave(const std::vector<std::string>& arguments);

// Starts cleave without waiting, its output thrown away; finish_cleave waits and returns the exit code.
pid_t start_cleave(const std::vector<std::string>& arguments);
int finish_cleave(pid_t process);

std::string read_text(const std::filesystem::path& path);
int count_lines(const std::string& text);

// A CSV file without line ends inside cells.
struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;

  const std::string& at(std::size_t row, const std::string& column) const;
  std::vector<std::string> column(const std::string& name) const;
};
CsvTable parse_csv(const std::string& text);
inline CsvTable read_csv(const std::filesystem::path& path) { return parse_csv(read_text(path)); }

}  // namespace cleave
