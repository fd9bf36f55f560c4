#include "harness/campaign/cell_result.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>

#include "harness/base/csv_text.h"
#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/base/printable_text.h"
#include "harness/files/checksums.h"
#include "harness/files/manifest.h"
#include "solver/step_solver.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double count(const StoredManifest& manifest, const char* name) {
  const auto found = manifest.result.find(name);
  return found == manifest.result.end() ? 0 : found->second;
}

// The first status in steps.csv that is not ok; empty where all are.
std::string first_failure(const fs::path& steps) {
  std::ifstream file(steps, std::ios::binary);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> header = split_csv_line(line);
  const auto place = static_cast<std::size_t>(std::ranges::find(header, "status") - header.begin());
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = split_csv_line(line);
    if (place < cells.size() && cells[place] != to_string(SolveStatus::ok)) return cells[place];
  }
  return {};
}

// A run that went through, but whose rows or worlds are not all as they should be.
void take_status(const fs::path& directory, const StoredManifest& manifest, IndexRow& row) {
  SolveStatus status = SolveStatus::ok;
  row.reason = "-";
  if (count(manifest, "inexact_advances") > 0) {
    status = SolveStatus::not_converged;
    row.reason = "a step was advanced by a solution outside the limit";
  }
  if (count(manifest, "stopped_worlds") > 0) {
    status = SolveStatus::diverged;
    row.reason = "a world was stopped early";
  }
  row.status = to_string(status);
  if (row.rows_ok == row.rows) return;
  row.status = first_failure(directory / kStepsFile);
  row.reason =
      std::to_string(row.rows - row.rows_ok) + " of " + std::to_string(row.rows) + " rows are not ok";
}

// The two files that every run leaves are those that were written.
bool is_sealed(const fs::path& directory) {
  const auto sums = read_checksums(directory);
  return is_as_listed(directory, sums, kManifestFile) && is_as_listed(directory, sums, kStepsFile);
}

}  // namespace

IndexRow pending_row(const CampaignCell& cell, int number) {
  IndexRow row;
  row.cell = cell.name();
  row.number = number;
  row.run_id = cell.run_id;
  row.round = cell.round;
  row.run_s = row.process_s = kUnknown;
  row.arguments = joined(cell.arguments(), " ");
  if (!cell.label.empty()) row.label = cell.label;
  return row;
}

void take_result(const fs::path& directory, const StoredManifest& manifest, IndexRow& row) {
  row.rows = static_cast<int>(count(manifest, "rows"));
  row.rows_ok = static_cast<int>(count(manifest, "rows_ok"));
  const auto wall = manifest.result.find("wall_s");
  row.run_s = wall == manifest.result.end() ? kUnknown : wall->second;
  row.machine = manifest.cpu_model;
  row.git_hash = manifest.git_hash;
  row.build = build_key(manifest.build);
  row.utc_start = manifest.utc_start;
  if (manifest.state == "complete") take_status(directory, manifest, row);
}

std::optional<StoredManifest> take_if_complete(const fs::path& out, IndexRow& row) {
  const fs::path directory = out / kCellsFolder / row.cell;
  std::error_code none;
  if (!fs::exists(directory / kChecksumsFile, none)) return std::nullopt;  // of a run, the last file
  try {
    StoredManifest manifest = read_manifest(directory / kManifestFile);
    if (manifest.state != "complete" || manifest.run_id != row.run_id || !is_sealed(directory))
      return std::nullopt;
    row.checksums = sha256_of(directory / kChecksumsFile);
    take_result(directory, manifest, row);
    return manifest;
  } catch (const std::exception&) {
    return std::nullopt;  // what cannot be read is not complete
  }
}

double seconds_of(const IndexRow& row) { return std::isnan(row.process_s) ? row.run_s : row.process_s; }

std::optional<IndexRow> complete_row(const fs::path& out, const CampaignCell& cell, int number,
                                     const std::string& build) {
  IndexRow row = pending_row(cell, number);
  const std::optional<StoredManifest> manifest = take_if_complete(out, row);
  const auto is_same = [&](const auto& option) {
    return manifest->option(option.first) == (option.second == "nan" ? "" : option.second);
  };
  const bool is_this = manifest && manifest->command == "run" && row.build == build &&
                       std::ranges::all_of(cell.beside_run_id, is_same);
  return is_this ? std::optional(row) : std::nullopt;
}

fs::path log_path(const fs::path& out, const IndexRow& row) {
  return out / kFailedFolder / (row.cell + ".log");
}

std::optional<fs::path> changed_file(const fs::path& out, const IndexRow& row) {
  const auto is_changed = [](const fs::path& path, const std::string& sum) {
    std::error_code none;
    return fs::is_regular_file(path, none) ? sha256_of(path) != sum : sum != "-";
  };
  for (const auto& [path, sum] : {std::pair(out / kCellsFolder / row.cell / kChecksumsFile, row.checksums),
                                  {log_path(out, row), row.log}})
    if (is_changed(path, sum)) return path;
  return std::nullopt;
}

bool still_stands(const fs::path& out, const IndexRow& row) {
  return !row.is_pending() && !changed_file(out, row);
}

void take_failure(const CellEnd& end, std::optional<double> limit_s, IndexRow& row) {
  const std::string last = end.last_line();
  SolveStatus status = SolveStatus::crashed;
  const bool has_begun = row.utc_start != "-";
  if (end.exit_code == 1 && !has_begun) status = SolveStatus::refused;
  if (end.exit_code == 1 && last.find("out of memory") != std::string::npos)
    status = SolveStatus::out_of_memory;
  if (limit_s) status = SolveStatus::timeout;
  row.status = to_string(status);
  row.reason = limit_s ? "took longer than " + number_text(*limit_s) + " s"
                       : end.text() + (last.empty() ? "" : ": " + printable(last));
}

}  // namespace cleave
