// The commands of the program. To add one: a file in this folder, declared here, and a row in command.cpp.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace cleave {

// Exit codes of the program.
enum ExitCode {
  kExitOk = 0,
  kExitBadInput = 1,
  kExitCellsFailed = 2,
  kExitVerifyFailed = 3,
  kExitInterrupted = 130,
  kExitReaderGone = 141
};

struct Command {
  const char* name;
  const char* help;
  // Declares the command's options on `app` and returns what to do once they are parsed: the exit code, or
  // std::invalid_argument / std::runtime_error with one line that main prints after "cleave <command>: ".
  std::function<int()> (*declare)(CLI::App& app, const std::vector<std::string>& argv);
};

std::span<const Command> commands();

std::function<int()> declare_list(CLI::App& app, const std::vector<std::string>& argv);
std::function<int()> declare_run(CLI::App& app, const std::vector<std::string>& argv);
std::function<int()> declare_record(CLI::App& app, const std::vector<std::string>& argv);
std::function<int()> declare_replay(CLI::App& app, const std::vector<std::string>& argv);
std::function<int()> declare_sweep(CLI::App& app, const std::vector<std::string>& argv);
std::function<int()> declare_rerun(CLI::App& app, const std::vector<std::string>& argv);
std::function<int()> declare_export(CLI::App& app, const std::vector<std::string>& argv);
std::function<int()> declare_import(CLI::App& app, const std::vector<std::string>& argv);
std::function<int()> declare_calibrate(CLI::App& app, const std::vector<std::string>& argv);
std::function<int()> declare_collect(CLI::App& app, const std::vector<std::string>& argv);
std::function<int()> declare_compare(CLI::App& app, const std::vector<std::string>& argv);
std::function<int()> declare_verify(CLI::App& app, const std::vector<std::string>& argv);

}  // namespace cleave
