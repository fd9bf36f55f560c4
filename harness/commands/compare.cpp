// cleave compare: the same cells measured twice, by two builds, on two machines or with two settings.
//
// Rows of A and B belong together where all columns of --by and the step are equal; several of one step
// (rounds) count by their median. A line is a group of --by: the ratio of the medians over the steps that
// both solved, B over A, and its bootstrap interval. Times of two processors are in no group of one campaign:
// `machine` in --by keeps them apart. A regression is a group whose whole interval lies above 1 + --allow, or
// that solved a step in A which B did not.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>

#include "harness/base/csv_text.h"
#include "harness/base/hash.h"
#include "harness/base/median.h"
#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/base/printable_text.h"
#include "harness/base/ratio_interval.h"
#include "harness/commands/command.h"
#include "harness/commands/measured_cells.h"
#include "harness/commands/verify_table.h"
#include "harness/experiment/step_record.h"

namespace cleave {
namespace {

struct CompareOptions {
  std::string a, b;
  std::string by = "run_id,problem_file,partitioner,refiner,solver,threads";
  std::string column = "t_s_ms", allow = "0.05";
};

using Texts = std::vector<std::string>;

// Of one step, over the rounds in which it was solved.
struct StepValues {
  std::vector<double> values;
  bool solved = false;
  std::string solution_hash;
};
struct Group {
  std::map<Texts, StepValues> steps;  // by seed and step
  std::string machine;                // processor of its first row
};
struct MeasuredGroups {
  std::map<Texts, Group> groups;  // by the columns of --by
  int incomplete = 0;             // cells that were killed, or are not at their end
};

// Of --by, beside the columns of steps.csv: as in the tables of cleave collect.
constexpr const char* kMachine = "machine";
constexpr int kMachinePlace = -1;

int place_of(const std::string& option, const std::string& name) {
  static const std::vector<Column> all = columns();
  check_name(option, name, names_of(std::span(all)));
  return static_cast<int>(std::ranges::find(all, name, &Column::name) - all.begin());
}

int place_in_by(const std::string& name) { return name == kMachine ? kMachinePlace : place_of("--by", name); }

// A median over times of two processors is of neither.
void check_machine(const std::string& directory, const std::string& known, const std::string& machine) {
  if (known == machine) return;
  throw std::invalid_argument(directory + ": a group of --by was measured on '" + known + "' and on '" +
                              machine + "', whose times have no common median; add machine to --by");
}

// NaN for what was not measured, which a column of integers says with -1.
double number_in(const MeasuredRow& row, int place) {
  static const std::vector<Column> all = columns();
  const double value = number_of_cell(row.place, all[place].name, row.cells[place]);
  return value == -1 && std::string_view(all[place].type) == "integer" ? kUnmeasured : value;
}

MeasuredGroups read_groups(const std::string& directory, const std::vector<int>& by, int column) {
  static const int seed = place_of("", "seed"), step = place_of("", "step"), status = place_of("", "status"),
                   hash = place_of("", "solution_hash");
  const bool is_of_machine = columns()[static_cast<std::size_t>(column)].machine;
  MeasuredGroups campaign;
  const auto add = [&](const MeasuredRow& row, const std::string& machine) {
    const Texts& cells = row.cells;
    Texts key;
    for (const int place : by) key.push_back(place == kMachinePlace ? machine : cells[place]);
    Group& group = campaign.groups.try_emplace(key, Group{{}, machine}).first->second;
    if (is_of_machine) check_machine(directory, group.machine, machine);
    StepValues& found = group.steps[{cells[seed], cells[step]}];
    if (cells[status] != "ok") return;
    found.solved = true;
    found.solution_hash = cells[hash];
    const double value = number_in(row, column);
    if (std::isfinite(value)) found.values.push_back(value);
  };
  visit_cells(find_measured_cells(std::span(&directory, 1)), [&](const MeasuredCell& cell,
                                                                 const StoredManifest& manifest) {
    const bool whole = visit_rows(cell, [&](const MeasuredRow& row) { add(row, manifest.cpu_model); });
    campaign.incomplete += !whole || manifest.state != "complete";
  });
  return campaign;
}

// What became of one group.
struct Comparison {
  std::vector<double> a, b;  // of the steps that both measured
  int lost = 0;              // steps that A solved and B did not, of those that B has rows of
  int other_solutions = 0;   // of those that both solved
};

Comparison compared(const Group& a, const Group& b) {
  Comparison result;
  for (const auto& [step, of_a] : a.steps) {
    const auto found = b.steps.find(step);
    if (!of_a.solved || found == b.steps.end()) continue;
    const StepValues& of_b = found->second;
    result.lost += !of_b.solved;
    if (!of_b.solved) continue;
    result.other_solutions += of_a.solution_hash != of_b.solution_hash;
    if (of_a.values.empty() || of_b.values.empty()) continue;
    result.a.push_back(median(of_a.values));
    result.b.push_back(median(of_b.values));
  }
  return result;
}

// The same draws for the same group.
std::uint64_t seed_of(const Texts& key) {
  Fnv1a64 hash;
  for (const std::string& cell : key) hash.add(std::string_view(cell));
  return hash.value();
}

const char* verdict_of(const RatioInterval& interval, std::size_t steps) {
  if (std::isnan(interval.ratio)) return "undecided";  // nothing in common, or both are 0
  if (steps < kFewestPairs) return "too-few-steps";
  if (std::isnan(interval.low)) return "undecided";  // both are 0 on many steps
  return interval.low > 1 ? "slower" : interval.high < 1 ? "faster" : "same";
}

// Prints the line of a group. True where it is a regression.
bool print_group(const Texts& key, const Comparison& group, double allow) {
  RatioInterval interval{kUnmeasured, kUnmeasured, kUnmeasured};
  double a = kUnmeasured, b = kUnmeasured;
  if (!group.a.empty()) {
    interval = ratio_interval(group.a, group.b, seed_of(key));
    a = median(group.a), b = median(group.b);
  }
  std::string line;
  for (const std::string& cell : key) line += csv_cell(cell) + ",";
  line += std::to_string(group.a.size()) + "," + std::to_string(group.lost) + "," +
          std::to_string(group.other_solutions);
  for (const double value : {a, b, interval.ratio, interval.low, interval.high})
    line += "," + number_text(value);
  std::printf("%s,%s\n", line.c_str(), group.lost > 0 ? "lost" : verdict_of(interval, group.a.size()));
  return group.lost > 0 || interval.low > 1 + allow;
}

std::vector<int> read_by(const std::string& text) {
  std::vector<int> by;
  const Texts names = split_list(text);
  for (const std::string& name : names) {
    by.push_back(place_in_by(name));
    if (std::ranges::count(names, name) > 1)
      throw std::invalid_argument("--by: " + name + " is given twice; name every column once");
  }
  return by;
}

int read_column(const std::string& name) {
  const int column = place_of("--column", name);
  if (std::string_view(columns()[column].type) == "text")
    throw std::invalid_argument("--column: " + name + " holds text; allowed is a column of numbers");
  return column;
}

// What the lines do not show.
std::string remarks(const MeasuredGroups& a, const MeasuredGroups& b, int machines) {
  std::string text;
  if (machines > 0) text += ", " + std::to_string(machines) + " groups on another processor in B";
  for (const auto& [campaign, name] : {std::pair(&a, " of A"), std::pair(&b, " of B")})
    if (campaign->incomplete > 0)
      text += "; " + std::to_string(campaign->incomplete) + " output directories" + name + " are incomplete";
  return text;
}

int compare(const CompareOptions& options) {
  if (options.a.empty() || options.b.empty())
    throw std::invalid_argument("A, B: two directories with output directories are required");
  const double allow = parse_number("--allow", options.allow, {0, 1e6});
  const int column = read_column(options.column);
  const std::vector<int> by = read_by(options.by);
  const MeasuredGroups a = read_groups(options.a, by, column), b = read_groups(options.b, by, column);
  const auto is_in = [](const MeasuredGroups& campaign) {
    return [&campaign](const auto& entry) { return campaign.groups.contains(entry.first); };
  };
  if (std::ranges::none_of(a.groups, is_in(b)))
    throw std::invalid_argument("--by: no group of " + options.by + " is in both; name fewer columns");
  std::printf("%s,steps,lost,other_solutions,a,b,ratio,low,high,verdict\n",
              joined(split_list(options.by), ",").c_str());
  int groups = 0, regressions = 0, machines = 0;
  for (const auto& [key, group] : a.groups) {
    if (!b.groups.contains(key)) continue;
    ++groups;
    machines += group.machine != b.groups.at(key).machine;
    regressions += print_group(key, compared(group, b.groups.at(key)), allow);
  }
  std::fflush(stdout);
  const auto alone = [&](const MeasuredGroups& one, const MeasuredGroups& other) {
    return std::to_string(std::ssize(one.groups) - std::ranges::count_if(one.groups, is_in(other)));
  };
  say(std::to_string(groups) + " groups in both, " + alone(a, b) + " in A alone, " + alone(b, a) +
      " in B alone; " + std::to_string(regressions) + " regressions" + remarks(a, b, machines));
  return regressions > 0 ? kExitVerifyFailed : kExitOk;
}

}  // namespace

std::function<int()> declare_compare(CLI::App& app, const std::vector<std::string>&) {
  const auto options = std::make_shared<CompareOptions>();
  app.add_option("a", options->a, "output directory, or directory that holds such")->type_name("A");
  app.add_option("b", options->b, "the other")->type_name("B");
  app.add_option("--by", options->by, "columns that rows of a group have in common, and machine")
      ->type_name("COLUMNS")
      ->capture_default_str();
  app.add_option("--column", options->column, "what is compared")->type_name("NAME")->capture_default_str();
  app.add_option("--allow", options->allow, "a regression is slower by more than this share")
      ->type_name("X")
      ->capture_default_str();
  return [options] { return compare(*options); };
}

}  // namespace cleave
