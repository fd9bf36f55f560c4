// The program: finds the command, parses its options, turns every error into one line on stderr and an exit
// code.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <functional>
#include <map>
#include <stdexcept>

#include "harness/base/names.h"
#include "harness/commands/command.h"
#include "harness/files/build_info.h"

namespace {

using namespace cleave;

std::vector<std::string> long_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// What the parser could not place, with the nearest thing it could.
void reject_extras(const CLI::App& app) {
  for (std::string extra : app.remaining()) {
    if (!extra.starts_with("-")) throw std::invalid_argument("unexpected argument '" + extra + "'");
    extra = extra.substr(0, extra.find('='));
    const std::string nearest = nearest_name(extra, long_options(app));
    const std::string question = nearest.empty() ? "" : " (did you mean " + nearest + "?)";
    throw std::invalid_argument(extra + ": no such option" + question + "; see cleave " + app.get_name() +
                                " --help");
  }
}

int run_program(int argc, char** argv) {
  CLI::App app("Graph partitioning for parallel direct solvers of rigid-body steps", "cleave");
  app.allow_extras();
  app.set_version_flag("--version", [] { return version_text(build_info()); });
  std::map<const CLI::App*, std::function<int()>> actions;
  const std::vector<std::string> arguments(argv, argv + argc);
  for (const Command& command : commands()) {
    CLI::App* sub = app.add_subcommand(command.name, command.help);
    sub->allow_extras();
    actions[sub] = command.declare(*sub, arguments);
  }

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  }
  if (app.get_subcommands().empty()) {
    const std::vector<std::string> extras = app.remaining();
    if (extras.empty()) throw std::invalid_argument("a command is required: " + joined(names_of(commands())));
    throw std::invalid_argument(unknown_name_text(extras.front(), names_of(commands())));
  }
  const CLI::App* chosen = app.get_subcommands().front();
  reject_extras(*chosen);
  return actions.at(chosen)();
}

}  // namespace

int main(int argc, char** argv) {
  const std::string command = argc > 1 && argv[1][0] != '-' ? std::string(" ") + argv[1] : "";
  try {
    return run_program(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cleave%s: %s\n", command.c_str(), error.what());
    return kExitBadInput;
  }
}
