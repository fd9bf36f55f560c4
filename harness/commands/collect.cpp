// cleave collect: the rows of many output directories in one table, with a table of the cells and one of the
// columns.
//
// `cell` and `machine` stand before the columns of steps.csv.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "harness/base/csv_text.h"
#include "harness/base/names.h"
#include "harness/base/printable_text.h"
#include "harness/base/refusals.h"
#include "harness/campaign/campaign_index.h"
#include "harness/commands/check_arguments.h"
#include "harness/commands/collected_tables.h"
#include "harness/commands/command.h"
#include "harness/commands/measured_cells.h"
#include "harness/experiment/step_record.h"
#include "harness/files/checksums.h"
#include "harness/files/manifest.h"
#include "harness/files/whole_file.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

struct CollectOptions {
  std::vector<std::string> directories;
  std::string out;
  bool force = false;
};

constexpr const char* kBefore[][2] = {
    {"cell", "output directory of the row; the key of the table of cells"},
    {"machine", "processor that the row was measured on; times of several are not to be averaged"},
};

std::string line_of(std::span<const std::string> cells) {
  std::vector<std::string> texts;
  for (const std::string& cell : cells) texts.push_back(csv_cell(cell));
  return joined(texts, ",");
}

// A row a cell; options that a cell does not have are empty. The header grows with the options that are met,
// at its end: a line that was written before wants as many commas more.
class TableOfCells {
 public:
  void add(const MeasuredCell& cell, const StoredManifest& manifest, long rows) {
    for (const OptionValue& option : manifest.options)
      if (std::ranges::find(options_, option.name) == options_.end()) options_.push_back(option.name);
    std::vector<std::string> line = {cell.name,          manifest.state,    std::to_string(rows),
                                     manifest.run_id,    manifest.command,  manifest.git_hash,
                                     manifest.cpu_model, manifest.utc_start};
    for (const std::string& name : options_) line.push_back(manifest.option(name));
    lines_.push_back({line_of(line), options_.size()});
  }

  std::string text() const {
    std::vector<std::string> header = {"cell",    "state",    "rows",    "run_id",
                                       "command", "git_hash", "machine", "utc_start"};
    for (const std::string& name : options_) header.push_back("option_" + column_of(name));
    std::string text = line_of(header) + "\n";
    for (const auto& [line, options] : lines_)
      text += line + std::string(options_.size() - options, ',') + "\n";
    return text;
  }

 private:
  struct Line {
    std::string text;
    std::size_t options;
  };
  std::vector<std::string> options_;
  std::vector<Line> lines_;
};

std::string table_of_columns() {
  std::string text = "column,type,machine,help\n";
  for (const auto& [name, help] : kBefore) text += line_of({{name, "text", "0", help}}) + "\n";
  for (const Column& column : columns())
    text += line_of({{column.name, column.type, column.machine ? "1" : "0", column.help}}) + "\n";
  return text;
}

struct Counts {
  long rows = 0, incomplete = 0;
};

Counts write_rows(std::span<const MeasuredCell> cells, GrowingFile& file, TableOfCells& table) {
  for (const auto& entry : kBefore) file.write(std::string(entry[0]) + ",");
  file.write(csv_header());
  Counts counts;
  visit_cells(cells, [&](const MeasuredCell& cell, const StoredManifest& manifest) {
    const std::string prefix = csv_cell(cell.name) + "," + csv_cell(manifest.cpu_model) + ",";
    long rows = 0;
    const bool whole =
        visit_rows(cell, [&](const MeasuredRow& row) { file.write(prefix + row.line + "\n"), ++rows; });
    table.add(cell, manifest, rows);
    counts.incomplete += !whole || manifest.state != "complete";
    counts.rows += rows;
  });
  file.finish();
  return counts;
}

// Nothing appears under its name before all is on the disk, the rows last.
void publish(const CollectedTables& files, GrowingFile& rows, const std::string& cells) {
  const std::string columns = table_of_columns();
  const auto line = [](const std::string& digits, const fs::path& path) {
    return checksum_line(digits, path.filename().string());
  };
  const std::string sums = line(sha256_of_bytes(columns), files.columns) +
                           line(sha256_of_bytes(cells), files.cells) +
                           line(sha256_of(part_name_of(files.rows)), files.rows);
  write_whole_files(
      std::vector<NamedBytes>{{files.checksums, sums}, {files.columns, columns}, {files.cells, cells}});
  rows.publish();
}

// Files of the runs, and a campaign's own.
std::vector<fs::path> files_read(std::span<const std::string> directories,
                                 std::span<const MeasuredCell> cells) {
  std::vector<fs::path> files;
  for (const std::string& directory : directories) files.push_back(fs::path(directory) / kIndexFile);
  for (const MeasuredCell& cell : cells)
    for (const char* name : {kStepsFile, kManifestFile, kChecksumsFile})
      files.push_back(cell.directory / name);
  return files;
}

// What a changed spec left in a campaign's directory counts like the rest, and is told.
void tell_earlier_cells(const std::vector<std::string>& directories) {
  for (const std::string& directory : directories) {
    const fs::path index = fs::path(directory) / kIndexFile;
    std::error_code none;
    if (!fs::exists(index, none)) continue;
    std::vector<IndexRow> rows;  // of a damaged index nothing is told: the rows of cells do not come from it
    if (!wrong_in([&] { rows = read_index(index); }).empty()) continue;
    const auto earlier = std::ranges::count_if(rows, [](const IndexRow& row) { return row.number == 0; });
    if (earlier > 0)
      say(directory + ": " + std::to_string(earlier) +
          " cells are of an earlier spec, and their rows are taken too");
  }
}

int collect(const CollectOptions& options) {
  if (options.directories.empty()) throw std::invalid_argument("DIR: an output directory is required");
  const CollectedTables files(options.out);
  for (const fs::path& path : {files.rows, files.cells, files.columns, files.checksums})
    check_out_file(path, options.force);
  const std::vector<MeasuredCell> cells = find_measured_cells(options.directories);
  const std::vector<fs::path> read = files_read(options.directories, cells);
  for (const fs::path& path : {files.rows, files.cells, files.columns, files.checksums})
    check_not_read(path, read);
  tell_earlier_cells(options.directories);
  GrowingFile rows(files.rows);
  TableOfCells table;
  const Counts counts = write_rows(cells, rows, table);
  publish(files, rows, table.text());
  say(options.out + ": " + std::to_string(counts.rows) + " rows of " + std::to_string(cells.size()) +
      " output directories" +
      (counts.incomplete > 0 ? ", " + std::to_string(counts.incomplete) + " of them incomplete" : ""));
  return kExitOk;
}

}  // namespace

std::function<int()> declare_collect(CLI::App& app, const std::vector<std::string>&) {
  const auto options = std::make_shared<CollectOptions>();
  app.add_option("directories", options->directories, "output directories, or directories that hold such")
      ->type_name("DIR ...");
  app.add_option("--out", options->out,
                 "table to write; those of cells and columns, and checksums of all, lie beside it")
      ->type_name("PATH");
  app.add_flag("--force", options->force, "overwrite the tables");
  return [options] { return collect(*options); };
}

}  // namespace cleave
