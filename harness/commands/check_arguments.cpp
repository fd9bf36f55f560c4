#include "harness/commands/check_arguments.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <vector>

#include "harness/base/names.h"
#include "harness/campaign/campaign_index.h"
#include "harness/files/output_directory.h"

namespace cleave {
namespace {

[[noreturn]] void reject(const std::string& text) { throw std::invalid_argument(text); }

bool is_flag(const CLI::Option& option) { return option.get_items_expected_min() == 0; }

std::vector<std::string> long_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// --name=value, or --name with its value or nothing behind it. Returns whether the next argument is the
// value.
bool check_option(const CLI::Option& option, const std::string& argument, const std::string* next) {
  const std::size_t equals = argument.find('=');
  const std::string name = argument.substr(0, equals);
  if (is_flag(option)) {
    if (equals != std::string::npos)
      reject(name + ": takes no value, not '" + argument.substr(equals + 1) + "'");
    return false;
  }
  if (equals != std::string::npos) {
    if (equals + 1 == argument.size()) reject(name + ": needs a value after the =");
    return false;
  }
  if (next == nullptr) reject(name + ": needs a value");
  if (next->starts_with("--"))
    reject(name + ": needs a value; '" + *next + "' is taken for one only when written " + name + "=" +
           *next);
  return true;
}

}  // namespace

void check_arguments(const CLI::App& command, std::span<const std::string> arguments) {
  std::set<std::string> given;
  bool options_over = false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    // The parser would end the command at ++.
    if (argument.empty() || argument == "++") reject("unexpected argument '" + argument + "'");
    if (argument == "--") options_over = true;
    if (options_over || !argument.starts_with("--")) continue;
    const std::string name = argument.substr(0, argument.find('='));
    const CLI::Option* option = command.get_option_no_throw(name);
    if (option == nullptr) continue;
    if (!given.insert(name).second) reject(name + ": is given twice");
    const std::string* next = i + 1 < arguments.size() ? &arguments[i + 1] : nullptr;
    if (check_option(*option, argument, next)) ++i;
  }
}

void check_out_file(const std::string& out, bool force) {
  if (out.empty()) reject("--out: is required: the file to write");
  std::error_code ignored;  // a name that cannot be looked at cannot be written either, and that says why
  if (std::filesystem::exists(out, ignored) && !force)
    reject("--out: " + out + " exists; name another file or give --force");
  // What is written takes the place of what was there, and a device or a link is not to be lost for that.
  const std::filesystem::file_status there = std::filesystem::symlink_status(out, ignored);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
    reject("--out: " + out + " is no regular file; name another");
  const std::filesystem::path directory = std::filesystem::path(out).parent_path();
  if (!directory.empty() && !std::filesystem::is_directory(directory, ignored))
    reject("--out: " + out + " cannot be written: there is no directory " + directory.string());
}

void check_run_directory(const std::string& out, bool force, const std::vector<std::string>& files) {
  check_output_directory(out, force, files);
  std::error_code ignored;
  if (std::filesystem::exists(std::filesystem::path(out) / kIndexFile, ignored))
    reject("--out: '" + out + "' holds a campaign; name another directory");
}

void check_not_read(const std::string& out, std::span<const std::filesystem::path> read) {
  std::error_code ignored;
  if (!std::filesystem::exists(out, ignored)) return;
  for (const std::filesystem::path& source : read)
    if (std::filesystem::equivalent(out, source, ignored))
      reject("--out: " + out + " would replace " + source.string() + ", which is read; name another file");
}

void reject_extras(const CLI::App& app) {
  std::vector<std::string> extras = app.remaining();
  // Before file names.
  if (const auto mark = std::ranges::find(extras, "--"); mark != extras.end()) extras.erase(mark);
  if (extras.empty()) return;
  if (!extras.front().starts_with("-")) reject("unexpected argument '" + extras.front() + "'");
  const std::string name = extras.front().substr(0, extras.front().find('='));
  const std::string nearest = nearest_name(name, long_options(app));
  const std::string question = nearest.empty() ? "" : " (did you mean " + nearest + "?)";
  reject(name + ": no such option" + question + "; see " + app.get_name() + " --help");
}

}  // namespace cleave
