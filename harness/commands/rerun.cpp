// cleave rerun: one run again, from its manifest alone; its rows must be those that it left, in all but times and threads.
#include <stdlib.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "harness/base/numbers.h"
#include "harness/base/printable_text.h"
#include "harness/campaign/cell_process.h"
#include "harness/commands/command.h"
#include "harness/commands/verify_checks.h"
#include "harness/commands/verify_table.h"
#include "harness/files/manifest.h"
#include "harness/files/manifest_reader.h"
#include "harness/files/output_directory.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

struct RerunOptions {
  std::string cell, out, threads;
};

// Where --out names none: in the system's place for such, and gone afterwards.
class WorkDirectory {
 public:
  explicit WorkDirectory(const std::string& out) : path_(out), is_own_(out.empty()) {
    if (!is_own_) return;
    std::string pattern = (fs::temp_directory_path() / "cleave_rerun_XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error(pattern + ": cannot be created");
    path_ = pattern;
  }
  ~WorkDirectory() {
    std::error_code ignored;
    if (is_own_) fs::remove_all(path_, ignored);
  }
  WorkDirectory(const WorkDirectory&) = delete;
  WorkDirectory& operator=(const WorkDirectory&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  bool is_own_;
};

StoredManifest checked_manifest(const fs::path& cell) {
  const StoredManifest manifest = read_manifest(cell / kManifestFile);
  const std::string text = (cell / kManifestFile).string();
  if (manifest.command != "run")
    throw std::invalid_argument(text + ": command is '" + manifest.command + "', allowed: run");
  if (manifest.state != "complete")
    throw std::invalid_argument(text + ": state is '" + manifest.state + "', allowed: complete");
  return manifest;
}

// Row by row, in every column but the machine's.
void compare_rows(const fs::path& cell, const fs::path& again, CheckList& list) {
  const StepsTable before(cell / "steps.csv"), now(again / "steps.csv");
  Findings wrong;
  if (before.row_count() != now.row_count())
    wrong.add("it has " + std::to_string(before.row_count()) + ", again " + std::to_string(now.row_count()));
  int compared = 0;
  for (const Column& column : columns()) {
    if (column.machine) continue;
    ++compared;
    for (std::size_t row = 0; row < std::min(before.row_count(), now.row_count()); ++row)
      if (const std::string& was = before.cell(row, column.name), &is = now.cell(row, column.name); was != is)
        wrong.add(StepsTable::line_of(row) + ": " + column.name + " = '" + was + "', again '" + is + "'");
  }
  list.add(wrong.none(), (cell / "steps.csv").string(),
           std::to_string(before.row_count()) + " rows against those of the repeated run, in " + std::to_string(compared) +
               " columns" + wrong.text());
}

int rerun(const RerunOptions& options, const std::string& program) {
  if (options.cell.empty()) throw std::invalid_argument("CELL: the output directory of a run is required");
  const StoredManifest manifest = checked_manifest(options.cell);
  if (!options.threads.empty()) parse_integer("--threads", options.threads, {1, 1024});
  if (!options.out.empty()) check_output_directory(options.out, false, {"steps.csv"});
  if (build_key(manifest.build) != build_key(build_info()))
    say(options.cell + ": was run by another build, of commit " + manifest.git_hash);
  const WorkDirectory work(options.out);
  CellCommand command{{program, "run", "--config=" + (fs::path(options.cell) / kManifestFile).string(),
                       "--out=" + work.path().string()},
                      std::numeric_limits<double>::quiet_NaN(),
                      {}};
  if (!options.threads.empty()) command.words.push_back("--threads=" + options.threads);
  bool interrupted = false;
  const CellEnd end = run_to_end(command, interrupted);
  if (interrupted) return kExitInterrupted;
  if (end.exit_code != kExitOk && end.exit_code != kExitCellsFailed)
    throw std::runtime_error(options.cell + ": its run " + end.text() +
                             (end.printed.empty() ? "" : ": " + end.last_line()));
  CheckList list;
  compare_rows(options.cell, work.path(), list);
  return list.failures() == 0 ? kExitOk : kExitVerifyFailed;
}

}  // namespace

std::function<int()> declare_rerun(CLI::App& app, const std::vector<std::string>& argv) {
  const auto options = std::make_shared<RerunOptions>();
  app.add_option("cell", options->cell, "output directory of a run, such as a cell of a campaign")
      ->type_name("CELL");
  app.add_option("--out", options->out, "directory that keeps the repeated run; where not given, none does")
      ->type_name("DIR");
  app.add_option("--threads", options->threads, "threads of a solve, in place of those it had")
      ->type_name("N");
  return [options, argv] { return rerun(*options, argv.front()); };
}

}  // namespace cleave
