// cleave sweep: a campaign of many runs from one file, each in a process of its own; given again, it goes on
// where it was.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>

#include "harness/base/csv_text.h"
#include "harness/base/numbers.h"
#include "harness/base/printable_text.h"
#include "harness/campaign/sweep.h"
#include "harness/commands/command.h"
#include "harness/files/directory_lock.h"
#include "harness/files/output_directory.h"
#include "solver/step_solver.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

constexpr int kListedFailures = 10;
constexpr Range kPositive{0, std::numeric_limits<double>::infinity(), true};

// As given; empty: not given.
struct Given {
  std::string spec, out, jobs = "1", pin = "0", shard = "1/1", cell_seconds, cell_memory_gb;
  bool dry_run = false, force = false, keep_failed = false, quiet = false, merge = false, take_over = false;
};

void read_shard(const std::string& text, SweepOptions& options) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos)
    throw std::invalid_argument("--shard: '" + text + "' is not of the form i/n, as 2/4");
  options.shards = parse_integer("--shard n", text.substr(slash + 1), {1, kMostCells});
  options.shard = parse_integer("--shard i", text.substr(0, slash), {1, static_cast<double>(options.shards)});
}

SweepOptions read_options(const Given& given, const std::string& program) {
  if (given.spec.empty()) throw std::invalid_argument("SPEC: a campaign's TOML file is required");
  if (given.out.empty()) throw std::invalid_argument("--out: is required: the campaign's directory");
  SweepOptions options;
  options.spec = given.spec;
  options.out = given.out;
  options.program = program;
  const double cores = static_cast<double>(usable_cores().size());
  options.jobs = parse_integer("--jobs", given.jobs, {1, 1024});
  options.pin = parse_integer("--pin", given.pin, {0, cores});
  if (options.jobs * options.pin > cores)
    throw std::invalid_argument("--pin: " + given.pin + " cores for each of --jobs " + given.jobs +
                                " are more than the " + number_text(cores) + " there are");
  read_shard(given.shard, options);
  if (!given.cell_seconds.empty())
    options.cell_seconds = parse_number("--cell-seconds", given.cell_seconds, kPositive);
  if (!given.cell_memory_gb.empty())
    options.cell_memory_gb = parse_number("--cell-memory-gb", given.cell_memory_gb, kPositive);
  if (given.force && given.keep_failed)
    throw std::invalid_argument(
        "--keep-failed: keeps cells, and --force runs all anew; leave out one of them");
  options.force = given.force;
  options.keep_failed = given.keep_failed || given.merge;
  options.quiet = given.quiet;
  options.take_over = given.take_over;
  options.merge = given.merge;
  return options;
}

void check_merge(const Given& given, const SweepOptions& options) {
  if (!given.merge) return;
  if (options.shards > 1)
    throw std::invalid_argument("--merge: puts the indexes of all shares into one; leave out --shard");
  const Given none;
  for (const auto& [name, is_given] : {std::pair("--force", given.force),
                                       {"--dry-run", given.dry_run},
                                       {"--keep-failed", given.keep_failed},
                                       {"--jobs", given.jobs != none.jobs},
                                       {"--pin", given.pin != none.pin},
                                       {"--cell-seconds", !given.cell_seconds.empty()},
                                       {"--cell-memory-gb", !given.cell_memory_gb.empty()}})
    if (is_given) throw std::invalid_argument(std::string("--merge: runs nothing; leave out ") + name);
}

// More threads than cores would measure how they wait for each other.
void check_threads(const SweepOptions& options, const Spec& spec) {
  if (options.pin == 0) return;
  for (const CampaignCell& cell : spec.cells)
    if (const std::string& threads = cell.beside_run_id.at("threads"); std::stoi(threads) > options.pin)
      throw std::invalid_argument("--pin: " + std::to_string(options.pin) + " is less than the " + threads +
                                  " threads of cell " + cell.name());
}

void check_shard(const SweepOptions& options, const Spec& spec) {
  if (options.shard > std::ssize(spec.cells))
    throw std::invalid_argument("--shard: share " + std::to_string(options.shard) + " of " +
                                std::to_string(options.shards) + " has none of the " +
                                std::to_string(spec.cells.size()) + " cells");
}

std::string about(const std::optional<double>& seconds) {
  return seconds ? ", about " + seconds_text(*seconds) : "";
}

int pending_of(const Campaign& campaign) {
  return static_cast<int>(std::ranges::count_if(campaign.rows(), &IndexRow::is_pending));
}

// On stdout a row a cell, in a merge a row a cell that is not ok.
void print_rows(const SweepOptions& options, const Campaign& campaign) {
  const CellTimes times = campaign.times();
  std::printf("number,cell,status,about_s,arguments,label\n");
  for (std::size_t k = 0; k < campaign.cells().size(); ++k) {
    const IndexRow& row = campaign.rows()[k];
    if (options.merge && row.status == to_string(SolveStatus::ok)) continue;
    const std::optional<double> seconds = row.is_pending() ? times.of(campaign.cells()[k]) : 0;
    std::printf("%d,%s,%s,%s,%s,%s\n", row.number, row.cell.c_str(), row.status.c_str(),
                seconds ? number_text(*seconds).c_str() : "nan", csv_cell(row.arguments).c_str(),
                csv_cell(row.label).c_str());
  }
}

// All of them; on stderr the sum.
int print_cells(const SweepOptions& options, const Campaign& campaign) {
  print_rows(options, campaign);
  const int pending = pending_of(campaign), all = static_cast<int>(campaign.cells().size());
  say(std::to_string(all) + " cells: " + std::to_string(all - pending) + " done, " + std::to_string(pending) +
      " to do" + about(campaign.seconds_left(campaign.times(), options.jobs)));
  return kExitOk;
}

void say_what_is_kept(const Campaign& campaign) {
  const std::size_t kept = campaign.cells().size() - static_cast<std::size_t>(pending_of(campaign));
  if (kept > 0) say(std::to_string(kept) + " cells are done and kept");
  if (campaign.of_other_build() > 0)
    say(std::to_string(campaign.of_other_build()) + " cells are of another build and run again");
  if (!campaign.earlier().empty())
    say(std::to_string(campaign.earlier().size()) +
        " cells of an earlier spec are not in this one; they stay");
}

// With the name of its log, which a label does not say.
std::string named(const IndexRow& row) {
  return row.label == "-" ? row.cell : row.label + " (" + row.cell + ")";
}

// The last lines and the exit code.
int conclude(const SweepOptions& options, const Campaign& campaign, const SweepSummary& summary) {
  std::map<std::string, int> counts;
  int not_ok = 0;
  for (const IndexRow& row : campaign.rows()) {
    ++counts[row.status];
    if (row.is_pending() || row.status == to_string(SolveStatus::ok)) continue;
    if (++not_ok <= kListedFailures) say(named(row) + ": " + row.status + ", " + row.reason);
  }
  if (not_ok > kListedFailures)
    say("... and " + std::to_string(not_ok - kListedFailures) + " more cells that are not ok");
  std::string text = std::to_string(campaign.rows().size()) + " cells:";
  for (const auto& [status, count] : counts) text += " " + std::to_string(count) + " " + status + ",";
  text.back() = ';';
  text += " " + std::to_string(summary.kept) + " kept";
  if (summary.elsewhere > 0) text += ", " + std::to_string(summary.elsewhere) + " run by another process";
  if (!options.quiet) say(text);
  if (options.merge) {
    print_rows(options, campaign);
    return not_ok > 0 || pending_of(campaign) > 0 ? kExitCellsFailed : kExitOk;
  }
  if (!summary.interrupted) return not_ok > 0 || pending_of(campaign) > 0 ? kExitCellsFailed : kExitOk;
  say("interrupted; the same command goes on");
  return kExitInterrupted;
}

int sweep(const Given& given, const std::string& program) {
  const SweepOptions options = read_options(given, program);
  Spec spec{read_spec(options.spec), {}};
  spec.cells = parse_campaign(spec.text, options.spec);
  check_threads(options, spec);
  check_shard(options, spec);
  check_merge(given, options);
  const fs::path share = share_directory(options.out, options.shard, options.shards);
  check_campaign_directory(options.out);
  if (given.dry_run) return print_cells(options, Campaign(options, spec));
  check_output_directory(share.string(), true, {});
  create_output_directory(share.string());
  const DirectoryLock lock(share, "cleave sweep",
                           options.take_over ? LeftElsewhere::take_over : LeftElsewhere::refuse);
  Campaign campaign(options, spec);
  if (!options.quiet) say_what_is_kept(campaign);
  const SweepSummary summary = run_campaign(options, spec.text, campaign);
  return conclude(options, campaign, summary);
}

}  // namespace

std::function<int()> declare_sweep(CLI::App& app, const std::vector<std::string>& argv) {
  const auto given = std::make_shared<Given>();
  const auto add = [&app](const char* name, std::string& value, const char* type, const char* help) {
    app.add_option(name, value, help)->type_name(type);
  };
  add("spec", given->spec, "SPEC.toml",
      "the campaign: option names of cleave run; a list or a range is a dimension");
  add("--out", given->out, "DIR", "the campaign's directory; what is complete there is kept");
  app.add_flag("--dry-run", given->dry_run,
               "run nothing; print the cells, which are done, and how long the others will take");
  add("--jobs", given->jobs, "N",
      "cells at a time (1, as times of cells side by side are not to be trusted)");
  add("--pin", given->pin, "N", "cores of a cell, no two cells on one (0: bound to none)");
  add("--shard", given->shard, "i/n",
      "run every n-th cell, from the i-th on; several may share a directory (1/1)");
  app.add_flag("--merge", given->merge,
               "run nothing; put what all shares did into one index and print the cells that are not ok");
  app.add_flag(
      "--take-over", given->take_over,
      "take over locks that another host left and nobody holds, as its processes are known to have ended");
  add("--cell-seconds", given->cell_seconds, "S", "longest that a cell may take, s, in (0, inf)");
  add("--cell-memory-gb", given->cell_memory_gb, "X",
      "most address space of a cell, GB (1e9 bytes), in (0, inf)");
  app.add_flag("--keep-failed", given->keep_failed,
               "keep cells whose process failed before, too, instead of trying them again");
  app.add_flag("--force", given->force, "run all cells anew");
  app.add_flag("--quiet", given->quiet, "say nothing but errors and cells that are not ok");
  return [given, argv] { return sweep(*given, argv.front()); };
}

}  // namespace cleave
