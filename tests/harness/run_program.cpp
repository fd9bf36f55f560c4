#include "tests/harness/run_program.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace cleave {
namespace {

std::vector<std::string> split_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

void redirect(int descriptor, const std::string& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || ::dup2(file, descriptor) < 0) ::_exit(126);
}

pid_t start(const std::string& program, const std::vector<std::string>& arguments, const std::string& out,
            const std::string& err) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t process = ::fork();
  if (process < 0) throw std::runtime_error("fork failed");
  if (process == 0) {
    redirect(STDOUT_FILENO, out);
    redirect(STDERR_FILENO, err);
    ::execv(program.c_str(), argv.data());
    ::_exit(127);
  }
  return process;
}

}  // namespace

TemporaryDirectory::TemporaryDirectory() {
  std::string pattern = (std::filesystem::temp_directory_path() / "cleave_test_XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error(pattern + ": mkdtemp failed");
  path_ = pattern;
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments) {
  const TemporaryDirectory files;
  const pid_t process = start(program, arguments, files / "out", files / "err");
  ProgramResult result;
  result.exit_code = finish_cleave(process);
  result.out = read_text(files / "out");
  result.err = read_text(files / "err");
  return result;
}

ProgramResult run_cleave(const std::vector<std::string>& arguments) {
  return run_program(CLEAVE_PROGRAM, arguments);
}

pid_t start_cleave(const std::vector<std::string>& arguments) {
  return start(CLEAVE_PROGRAM, arguments, "/dev/null", "/dev/null");
}

int finish_cleave(pid_t process) {
  int status = 0;
  if (::waitpid(process, &status, 0) != process) return -1;
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

int count_lines(const std::string& text) { return static_cast<int>(std::ranges::count(text, '\n')); }

const std::string& CsvTable::at(std::size_t row, const std::string& column) const {
  const auto found = std::ranges::find(header, column);
  if (found == header.end()) throw std::out_of_range("no column " + column);
  return rows.at(row).at(static_cast<std::size_t>(found - header.begin()));
}

std::vector<std::string> CsvTable::column(const std::string& name) const {
  std::vector<std::string> cells;
  for (std::size_t row = 0; row < rows.size(); ++row) cells.push_back(at(row, name));
  return cells;
}

CsvTable parse_csv(const std::string& text) {
  CsvTable table;
  std::istringstream lines(text);
  std::string line;
  if (std::getline(lines, line)) table.header = split_cells(line);
  while (std::getline(lines, line)) table.rows.push_back(split_cells(line));
  return table;
}

}  // namespace cleave
