#include "harness/program.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <functional>
#include <new>
#include <span>
#include <stdexcept>

#include "harness/base/names.h"
#include "harness/base/printable_text.h"
#include "harness/base/standard_streams.h"
#include "harness/commands/check_arguments.h"
#include "harness/commands/command.h"
#include "harness/files/build_info.h"

namespace cleave {
namespace {

using Arguments = std::vector<std::string>;

struct Program {
  std::string name;
  std::vector<Command> commands;
};

// Of the program's arguments: a command comes first, or an option of the program's own stands alone.
void check_first(const Program& program, std::span<const std::string> arguments) {
  const Arguments names = names_of(std::span(program.commands));
  if (arguments.empty()) throw std::invalid_argument("a command is required: " + joined(names));
  const std::string& first = arguments.front();
  if (std::ranges::count(names, first) > 0) return;
  if (!first.starts_with("-")) throw std::invalid_argument(unknown_name_text(first, names));
  if (std::ranges::count(Arguments{"-h", "--help", "--version"}, first) == 0)
    throw std::invalid_argument(first + ": no such option before a command; see " + program.name + " --help");
  if (arguments.size() > 1) throw std::invalid_argument("unexpected argument '" + arguments[1] + "'");
}

// Whether there is nothing to do but to print help or version, which it does.
bool prints_help(CLI::App& app, std::span<const std::string> arguments) {
  try {
    app.parse(Arguments(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& help) {
    app.exit(help);
    return true;
  }
  return false;
}

// Help that names the commands, or the version.
int print_about(const Program& program, std::span<const std::string> arguments) {
  CLI::App app("Graph partitioning for parallel direct solvers of rigid-body steps", program.name);
  app.set_version_flag("--version", [] { return version_text(build_info()); });
  for (const Command& command : program.commands) app.add_subcommand(command.name, command.help);
  prints_help(app, arguments);
  return kExitOk;
}

int run_command(const Program& program, const Arguments& arguments) {
  const std::span<const std::string> given = std::span(arguments).subspan(1);
  for (const std::string& argument : given)
    if (!is_utf8(argument))
      throw std::invalid_argument("argument '" + argument + "' is not UTF-8, in which manifests hold it");
  check_first(program, given);
  const auto command = std::ranges::find(program.commands, given.front(),
                                         [](const Command& row) { return std::string(row.name); });
  if (command == program.commands.end()) return print_about(program, given);
  CLI::App app(command->help, program.name + " " + given.front());
  app.allow_extras();
  const std::function<int()> act = command->declare(app, arguments);
  check_arguments(app, given.subspan(1));
  if (prints_help(app, given.subspan(1))) return kExitOk;
  reject_extras(app);
  return act();
}

// The exit code; what goes wrong is said.
int guarded(const std::string& name, const std::function<int()>& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    say(name + ": out of memory");
  } catch (const std::exception& error) {
    say(name + ": " + error.what());
  }
  return kExitBadInput;
}

}  // namespace

int run_program(const std::string& name, std::span<const Command> more, int argc, char** argv) {
  open_standard_streams();
  Program program{name, {commands().begin(), commands().end()}};
  program.commands.insert(program.commands.end(), more.begin(), more.end());
  const std::string begin = argc > 1 && argv[1][0] != '-' ? name + " " + argv[1] : name;
  const int code = guarded(begin, [&] { return run_command(program, Arguments(argv, argv + argc)); });
  const int output = guarded(
      begin, [] { return finish_standard_output() == OutputState::whole ? kExitOk : kExitReaderGone; });
  return code == kExitOk ? output : code;
}

}  // namespace cleave
