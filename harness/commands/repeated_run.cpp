#include "harness/commands/repeated_run.h"

#include <stdlib.h>

#include <limits>
#include <stdexcept>

#include "harness/base/printable_text.h"
#include "harness/campaign/cell_process.h"
#include "harness/commands/command.h"
#include "harness/commands/verify_table.h"
#include "harness/experiment/earlier_tables.h"
#include "harness/experiment/repeated_options.h"
#include "harness/files/manifest.h"
#include "harness/files/manifest_reader.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

// Where none is named: in the system's place for such, and gone afterwards.
class WorkDirectory {
 public:
  explicit WorkDirectory(const fs::path& out) : path_(out), is_own_(out.empty()) {
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
void compare_rows(const fs::path& cell, const fs::path& again, const std::string& how, CheckList& list) {
  StepsTable before(cell / kStepsFile);
  const StepsTable now(again / kStepsFile);
  if (are_columns_of_schema(before.header())) before.add_later_columns();
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
  list.add(wrong.none(), (cell / kStepsFile).string(),
           std::to_string(before.row_count()) + " rows against those of the repeated run" + how + ", in " +
               std::to_string(compared) + " columns" + wrong.text());
}

CellCommand command_of(const RepeatedRun& run, const fs::path& out) {
  CellCommand command{
      {run.program, "run", "--config=" + (run.directory / kManifestFile).string(), "--out=" + out.string()},
      std::numeric_limits<double>::quiet_NaN(),
      {}};
  if (run.threads) command.words.push_back("--threads=" + std::to_string(*run.threads));
  if (run.force) command.words.push_back("--force");
  for (const auto& [name, value] : run.files) command.words.push_back("--" + name + "=" + value);
  return command;
}

}  // namespace

std::vector<std::string> missing_files(const RepeatedRun& run) {
  std::vector<std::string> names =
      options_of_files(read_manifest_options(run.directory / kManifestFile, "run"));
  std::erase_if(names, [&](const std::string& name) { return run.files.contains(name); });
  return names;
}

bool check_repeated_run(const RepeatedRun& run, CheckList& list) {
  const std::string cell = run.directory.string();
  const StoredManifest manifest = checked_manifest(run.directory);
  if (build_key(manifest.build) != build_key(build_info()))
    say(cell + ": was run by another build, of commit " + manifest.git_hash);
  if (const std::vector<std::string> missing = missing_files(run); !missing.empty())
    throw std::invalid_argument("--" + missing.front() + ": is required, as " + cell +
                                " knows of its file what stood in it and not where it lies");
  const WorkDirectory work(run.out);
  bool interrupted = false;
  const CellEnd end = run_to_end(command_of(run, work.path()), interrupted);
  if (interrupted) return false;
  if (end.exit_code != kExitOk && end.exit_code != kExitCellsFailed)
    throw std::runtime_error(cell + ": its run " + end.text() +
                             (end.printed.empty() ? "" : ": " + end.last_line()));
  compare_rows(run.directory, work.path(),
               run.threads ? " with --threads " + std::to_string(*run.threads) : "", list);
  return true;
}

}  // namespace cleave
