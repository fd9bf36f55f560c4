// No argument is passed over: what the parser itself would take without a word.
#include <gtest/gtest.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <string>
#include <vector>

#include "harness/base/names.h"
#include "harness/commands/check_arguments.h"
#include "harness/commands/command.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
void expect_refused(const Arguments& arguments, const std::string& piece) {
  const TemporaryDirectory directory;
  SCOPED_TRACE(joined(arguments, " "));
  const std::string line = "cd '" + directory.path().string() + "' && exec '" + CLEAVE_PROGRAM + "' \"$@\"";
  Arguments all = {"-c", line, "cleave"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const ProgramResult result = run_program("/bin/bash", all);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(count_lines(result.err), 1) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_NE(result.err.find(piece), std::string::npos) << piece << " in " << result.err;
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST(Arguments, WhatNothingTakesIsRefused) {
  const Arguments run = {"run", "--scene", "rock_pile", "--steps", "0", "--out", "out"};
  const auto after = [&run](Arguments more) {
    more.insert(more.begin(), run.begin(), run.end());
    return more;
  };
  const auto before = [&run](Arguments first) {
    first.insert(first.end(), run.begin(), run.end());
    return first;
  };
  expect_refused(before({"--threads", "2"}), "--threads: no such option before a command");
  expect_refused(before({"--nope"}), "--nope: no such option before a command");
  expect_refused(before({"--version"}), "'run'");
  expect_refused(before({"--"}), "--");
  expect_refused(before({"--run.steps=1"}), "--run.steps=1");
  expect_refused(before({"junk"}), "'junk' is unknown");
  expect_refused(before({""}), "'' is unknown");
  expect_refused(after({"verify", "FILE"}), "unexpected argument 'verify'");
  expect_refused(after({"run"}), "unexpected argument 'run'");
  expect_refused(after({"--", "extra"}), "unexpected argument 'extra'");
  expect_refused(after({"--", "--force"}), "--force");
  expect_refused(after({"++"}), "unexpected argument '++'");
  expect_refused(after({"++", "extra"}), "unexpected argument '++'");
  expect_refused(after({""}), "unexpected argument ''");
  expect_refused(after({"-x"}), "-x");
  expect_refused({"list", ""}, "unexpected argument ''");
  expect_refused({"list", "scenes", "solvers"}, "unexpected argument 'solvers'");
  expect_refused({"list", "--names=1"}, "--names: takes no value, not '1'");
  expect_refused({"verify", ""}, "unexpected argument ''");
  expect_refused({"replay", "", "--out", "out"}, "unexpected argument ''");
  expect_refused({"export", "", "--format", "metis", "--out", "out"}, "unexpected argument ''");
  expect_refused({"replay", "file.h5", "--cold=2", "--out", "out"}, "--cold: takes no value, not '2'");
  expect_refused({"replay", "file.h5", "--out", "--cold"}, "--out: needs a value");
}

TEST(Arguments, ControlCharactersAreShownAndNotPrinted) {
  expect_refused({"verify", "a\nb"}, "cleave verify: a\\x0ab: ");
  expect_refused({"\033[31m"}, "cleave \\x1b[31m: ");
  expect_refused({"list", "\033[31m"}, "\\x1b[31m");
}

TEST(Arguments, FileNamesMayStandBehindTwoDashes) {
  const TemporaryDirectory directory;
  const std::string steps = directory / "recorded";
  const ProgramResult recorded =
      run_cleave({"record", "--scene", "rock_pile", "--bodies", "3", "--at", "2", "--out", steps});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  const std::string file = steps + "/rock_pile_step000002.h5";
  const ProgramResult replayed = run_cleave({"replay", "--out", directory / "out", "--", file});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  fs::copy_file(file, directory / "--force");
  const ProgramResult both =
      run_program("/bin/bash", {"-c", "cd '" + directory.path().string() + "' && exec '" + CLEAVE_PROGRAM +
                                          "' replay --out both '" + file + "' -- --force"});
  EXPECT_EQ(both.exit_code, 0) << both.err;
  EXPECT_EQ(read_csv(directory / "both/steps.csv").rows.size(),
            2 * read_csv(directory / "out/steps.csv").rows.size());
  const ProgramResult dashes = run_cleave({"replay", "--out", directory / "other", "--", "--cold"});
  EXPECT_EQ(dashes.exit_code, 1);
  EXPECT_NE(dashes.err.find("--cold: "), std::string::npos) << dashes.err;
}

// Of every command: its declaration, as the program makes it.
struct Declared {
  explicit Declared(const Command& command) : app("", command.name) {
    app.allow_extras();
    act = command.declare(app, {});
  }
  CLI::App app;
  std::function<int()> act;
};

std::string refusal(const CLI::App& app, const Arguments& arguments) {
  try {
    check_arguments(app, arguments);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Arguments, EveryOptionOfEveryCommandInEveryWrongForm) {
  int options = 0, flags = 0;
  for (const Command& command : commands()) {
    const Declared declared(command);
    for (const CLI::Option* option : declared.app.get_options()) {
      if (option->get_lnames().empty()) continue;
      const std::string name = "--" + option->get_lnames().front();
      SCOPED_TRACE(std::string(command.name) + " " + name);
      const bool flag = option->get_items_expected_min() == 0;
      ++(flag ? flags : options);
      if (flag) {
        for (const char* value : {"=", "=true", "=0"})
          EXPECT_NE(refusal(declared.app, {name + value}).find(name + ": takes no value"), std::string::npos);
        EXPECT_EQ(refusal(declared.app, {name, name}), name + ": is given twice");
        EXPECT_EQ(refusal(declared.app, {name}), "");
      } else {
        EXPECT_EQ(refusal(declared.app, {name}), name + ": needs a value");
        EXPECT_EQ(refusal(declared.app, {name + "="}), name + ": needs a value after the =");
        EXPECT_NE(refusal(declared.app, {name, name}).find("needs a value"), std::string::npos);
        EXPECT_EQ(refusal(declared.app, {name, "1", name + "=1"}), name + ": is given twice");
        EXPECT_EQ(refusal(declared.app, {name, "-1"}), "");
        EXPECT_EQ(refusal(declared.app, {name + "=--x"}), "");
      }
    }
  }
  EXPECT_GE(options, 100);
  EXPECT_GE(flags, 10);
}

// A name that is cut short is no name.
TEST(Arguments, NoOptionMayBeAbbreviated) {
  for (const Command& command : commands()) {
    Declared declared(command);
    for (const CLI::Option* option : declared.app.get_options()) {
      if (option->get_lnames().empty()) continue;
      const std::string name = "--" + option->get_lnames().front();
      const std::string cut = name.substr(0, name.size() - 1);
      if (declared.app.get_option_no_throw(cut) != nullptr) continue;
      SCOPED_TRACE(std::string(command.name) + " " + cut);
      Declared fresh(command);
      fresh.app.parse(Arguments{cut});
      EXPECT_THROW(reject_extras(fresh.app), std::invalid_argument);
    }
  }
}

// An empty text is no value of any option.
TEST(Arguments, NoOptionTakesAnEmptyValue) {
  const std::vector<Arguments> beginnings = {{"run", "--scene", "rock_pile", "--steps", "0"},
                                             {"record", "--scene", "rock_pile", "--at", "0"},
                                             {"export", "file.h5", "--format", "metis"}};
  for (const Arguments& beginning : beginnings) {
    const auto command = std::ranges::find(commands(), beginning.front(),
                                           [](const Command& c) { return std::string(c.name); });
    const Declared declared(*command);
    for (const CLI::Option* option : declared.app.get_options()) {
      if (option->get_lnames().empty() || option->get_items_expected_min() == 0) continue;
      const std::string name = "--" + option->get_lnames().front();
      if (std::ranges::count(beginning, name) > 0) continue;
      Arguments arguments = beginning;
      arguments.insert(arguments.end(), {name, ""});
      if (name != "--out") arguments.insert(arguments.end(), {"--out", "out"});
      expect_refused(arguments, name);
    }
  }
}

}  // namespace
}  // namespace cleave
