// cleave list [what]: the registry tables as aligned text on stdout.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "harness/commands/command.h"
#include "harness/friction.h"
#include "harness/nearest_name.h"
#include "harness/solver_choices.h"
#include "harness/step_record.h"
#include "partition/registry.h"
#include "scenarios/scene.h"
#include "solver/registry.h"

namespace cleave {
namespace {

struct Line {
  std::string name, help, reference;
};

struct Listing {
  const char* name;
  std::vector<Line> (*lines)();
};

template <class Table>
std::vector<Line> lines_of(const Table& table) {
  std::vector<Line> lines;
  for (const auto& row : table) {
    if constexpr (requires { row.entry.name; }) {
      lines.push_back({row.entry.name, row.entry.help, row.entry.reference});
    } else {
      lines.push_back({row.name, row.help, row.reference});
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

constexpr Listing kListings[] = {
    {"scenes", [] { return lines_of(scenes()); }},
    {"partitioners", [] { return lines_of(partitioners()); }},
    {"refiners", [] { return lines_of(refiners()); }},
    {"solvers", [] { return lines_of(solver_entries()); }},
    {"strategies", [] { return lines_of(strategy_table()); }},
    {"kernels", [] { return lines_of(kernel_table()); }},
    {"frictions", [] { return lines_of(friction_models()); }},
    {"columns", column_lines},
};

void print_names(const std::vector<Line>& lines) {
  for (const Line& line : lines) std::puts(line.name.c_str());
}

void print_table(const char* title, const std::vector<Line>& lines) {
  int name_width = 0, help_width = 0;
  for (const Line& line : lines) {
    name_width = std::max(name_width, static_cast<int>(line.name.size()));
    if (!line.reference.empty()) help_width = std::max(help_width, static_cast<int>(line.help.size()));
  }
  std::printf("%s\n", title);
  for (const Line& line : lines) {
    std::printf("  %-*s  ", name_width, line.name.c_str());
    if (line.reference.empty() || line.reference == "-") {
      std::printf("%s\n", line.help.c_str());
    } else {
      std::printf("%-*s  [%s]\n", help_width, line.help.c_str(), line.reference.c_str());
    }
  }
}

int list(const std::string& what, bool names_only) {
  const std::vector<std::string> choices = names_of(std::span(kListings));
  if (!what.empty() && std::ranges::find(choices, what) == choices.end())
    throw std::invalid_argument(unknown_name_text(what, choices));
  for (const Listing& listing : kListings) {
    // The columns are many; they are shown when asked for.
    if (what.empty() ? listing.name == std::string("columns") : listing.name != what) continue;
    if (names_only) {
      print_names(listing.lines());
    } else {
      print_table(listing.name, listing.lines());
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
  app.add_option("what", options->what, joined(names_of(std::span(kListings)), "|"));
  app.add_flag("--names", options->names_only, "names only, one a line");
  return [options] { return list(options->what, options->names_only); };
}

}  // namespace cleave
