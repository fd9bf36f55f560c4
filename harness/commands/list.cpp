// cleave list [what]: the registry tables as aligned text on stdout, each algorithm with its parameters.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "harness/base/names.h"
#include "harness/commands/command.h"
#include "harness/experiment/algorithms.h"
#include "harness/experiment/step_record.h"

namespace cleave {
namespace {

struct Line {
  std::string name, help, reference;
  bool is_parameter = false;
};

Line parameter_line(const Parameter& parameter) {
  const std::string value =
      parameter.default_value.empty() ? "must be given" : parameter.default_value + " by default";
  const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
  return {"@" + parameter.name, parameter.help + "; " + allowed_text(parameter) + unit + ", " + value,
          parameter.source, true};
}

// The registries that an option names its algorithms from.
std::vector<Line> algorithm_lines(const std::string& plural) {
  std::string option;
  for (const AlgorithmKind& kind : algorithm_kinds())
    if (kind.plural == plural) option = kind.option;
  std::vector<Line> lines;
  for (const AlgorithmKind& kind : algorithm_kinds()) {
    if (kind.option != option) continue;
    for (const AlgorithmEntry& entry : kind.entries) {
      const std::string unavailable = unavailable_text(entry);
      lines.push_back(
          {entry.name, entry.help + (unavailable.empty() ? "" : "; " + unavailable), entry.reference});
      for (const Parameter& parameter : entry.parameters) lines.push_back(parameter_line(parameter));
    }
  }
  return lines;
}

std::vector<Line> column_lines() {
  std::vector<Line> lines;
  for (const Column& column : columns())
    lines.push_back({column.name, column.help, column.machine ? "the machine's" : ""});
  return lines;
}

// One table an option, and the columns.
std::vector<std::string> listings() {
  std::vector<std::string> names, options;
  for (const AlgorithmKind& kind : algorithm_kinds()) {
    if (std::ranges::count(options, kind.option) > 0) continue;
    options.push_back(kind.option);
    names.push_back(kind.plural);
  }
  names.push_back("columns");
  return names;
}

void print_names(const std::vector<Line>& lines) {
  for (const Line& line : lines)
    if (!line.is_parameter) std::puts(line.name.c_str());
}

void print_table(const char* title, const std::vector<Line>& lines) {
  int name_width = 0, help_width = 0;
  for (const Line& line : lines) {
    if (line.is_parameter) continue;
    name_width = std::max(name_width, static_cast<int>(line.name.size()));
    if (!line.reference.empty()) help_width = std::max(help_width, static_cast<int>(line.help.size()));
  }
  std::printf("%s\n", title);
  for (const Line& line : lines) {
    if (line.is_parameter) {
      const std::string reference = line.reference.empty() ? "" : "  [" + line.reference + "]";
      std::printf("  %-*s    %s: %s%s\n", name_width, "", line.name.c_str(), line.help.c_str(),
                  reference.c_str());
      continue;
    }
    std::printf("  %-*s  ", name_width, line.name.c_str());
    if (line.reference.empty() || line.reference == "-") {
      std::printf("%s\n", line.help.c_str());
    } else {
      std::printf("%-*s  [%s]\n", help_width, line.help.c_str(), line.reference.c_str());
    }
  }
}

int list(const std::string& what, bool names_only) {
  const std::vector<std::string> choices = listings();
  if (!what.empty()) check_name("WHAT", what, choices);
  for (const std::string& name : choices) {
    const bool is_columns = name == choices.back();
    // The columns are many; they are shown when asked for.
    if (what.empty() ? is_columns : name != what) continue;
    const std::vector<Line> lines = is_columns ? column_lines() : algorithm_lines(name);
    if (names_only) {
      print_names(lines);
    } else {
      print_table(name.c_str(), lines);
    }
  }
  return kExitOk;
}

}  // namespace

std::function<int()> declare_list(CLI::App& app, const std::vector<std::string>&) {
  struct Options {
    std::string what;
    bool names_only = false;
  };
  const auto options = std::make_shared<Options>();
  app.add_option("what", options->what, joined(listings(), "|"));
  app.add_flag("--names", options->names_only, "names only, one a line");
  return [options] { return list(options->what, options->names_only); };
}

}  // namespace cleave
