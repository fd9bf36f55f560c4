// cleave verify: checks what is stored from the files alone.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "harness/commands/command.h"
#include "harness/commands/verify_checks.h"
#include "harness/commands/verify_directory.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

void verify_file(const fs::path& path, CheckList& list) {
  check_problem_file(path, read_problem_file_aloud(path), list);
}

int verify(const std::vector<std::string>& paths) {
  if (paths.empty()) throw std::invalid_argument("PATHS: problem files or output directories are required");
  CheckList list;
  for (const std::string& path : paths) {
    if (fs::is_directory(path)) {
      verify_directory(path, list);
    } else {
      verify_file(path, list);
    }
  }
  std::fflush(stdout);
  std::fprintf(stderr, "%d checks, %d failed\n", list.checks(), list.failures());
  return list.failures() == 0 ? kExitOk : kExitVerifyFailed;
}

}  // namespace

std::function<int()> declare_verify(CLI::App& app, const std::vector<std::string>&) {
  const auto paths = std::make_shared<std::vector<std::string>>();
  app.add_option("paths", *paths, "problem files, or directories that hold them or steps.csv")
      ->type_name("PATHS");
  return [paths] { return verify(*paths); };
}

}  // namespace cleave
