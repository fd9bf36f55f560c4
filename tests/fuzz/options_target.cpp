// Options as they are typed, beside those of a manifest, up to what a run is made from.
//
// The first line of the bytes is a command (run, record, replay), each other line one argument; lines that
// begin with "= " are options that a manifest holds, "= name=value".
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <map>
#include <sstream>

#include "harness/commands/run_command_line.h"
#include "tests/fuzz/options_roundtrip.h"
#include "tests/fuzz/target.h"

namespace cleave::fuzz {
namespace {

using Given = std::map<std::string, std::string>;

// The command line of a command; parsing leaves its options in `given`.
struct CommandLine {
  CLI::App app;
  Given given;
  explicit CommandLine(bool CommandSet::*command) { declare_run_options(app, given, command); }
};

// Declared once: that takes longer than the parsing.
CommandLine& command_line(bool CommandSet::*command) {
  static CommandLine run(&CommandSet::run), record(&CommandSet::record), replay(&CommandSet::replay);
  return command == &CommandSet::run ? run : command == &CommandSet::record ? record : replay;
}

struct Request {
  bool CommandSet::*command = &CommandSet::run;
  std::vector<std::string> arguments;
  Given stored;
};

Request request_of(std::string_view bytes) {
  Request request;
  std::istringstream text{std::string(bytes)};
  std::string line;
  std::getline(text, line);
  if (line == "record") request.command = &CommandSet::record;
  if (line == "replay") request.command = &CommandSet::replay;
  while (std::getline(text, line)) {
    const std::size_t equals = line.find('=', 2);
    if (!line.starts_with("= ")) {
      request.arguments.push_back(line);
    } else if (equals != std::string::npos) {
      request.stored[line.substr(2, equals - 2)] = line.substr(equals + 1);
    }
  }
  return request;
}

// CLI::Error is a std::runtime_error; --help is one of them.
Given given_of(const Request& request) {
  CommandLine& line = command_line(request.command);
  line.given.clear();
  std::vector<std::string> reversed = request.arguments;
  std::ranges::reverse(reversed);
  line.app.parse(reversed);
  return line.given;
}

}  // namespace

void read_options(std::string_view bytes) {
  // Names of files that may exist are left to the test of each reader.
  if (bytes.find('/') != std::string_view::npos) return;
  const Request request = request_of(bytes);
  Given given;
  if (refuses([&] { given = given_of(request); })) return;
  given.erase("config");
  check_options(request.command, request.stored, given);
}

}  // namespace cleave::fuzz
