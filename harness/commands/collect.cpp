// cleave collect: the rows of many output directories in one table, with a table of the cells and one of the columns.
//
// results.csv has a row per measured cell and step, `cell` and `machine` before the columns of steps.csv; results.cells.csv
// a row per output directory with its options, joined by `cell`; results.columns.csv says what each column is.
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>

#include "harness/base/csv_text.h"
#include "harness/base/names.h"
#include "harness/base/printable_text.h"
#include "harness/commands/check_arguments.h"
#include "harness/commands/command.h"
#include "harness/commands/measured_cells.h"
#include "harness/experiment/step_record.h"
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
  return joined(texts, ",") + "\n";
}

// "results.csv" to "results.cells.csv".
fs::path beside(const fs::path& out, const std::string& name) {
  return out.parent_path() / (out.stem().string() + "." + name + out.extension().string());
}

// A row a cell; options that a cell does not have are empty.
std::string table_of_cells(std::span<const MeasuredCell> cells, const std::map<std::string, long>& rows) {
  std::vector<std::string> options;
  for (const MeasuredCell& cell : cells)
    for (const OptionValue& option : cell.manifest.options)
      if (std::ranges::find(options, option.name) == options.end()) options.push_back(option.name);
  std::vector<std::string> header = {"cell",    "state",    "rows",    "run_id",
                                     "command", "git_hash", "machine", "utc_start"};
  for (const std::string& name : options) header.push_back("option_" + column_of(name));
  std::string text = line_of(header);
  for (const MeasuredCell& cell : cells) {
    const StoredManifest& manifest = cell.manifest;
    std::vector<std::string> line = {
        cell.name,          manifest.state,    std::to_string(rows.at(cell.name)),
        manifest.run_id,    manifest.command,  manifest.git_hash,
        manifest.cpu_model, manifest.utc_start};
    for (const std::string& name : options) line.push_back(manifest.option(name));
    text += line_of(line);
  }
  return text;
}

std::string table_of_columns() {
  std::string text = "column,type,machine,help\n";
  for (const auto& [name, help] : kBefore) text += line_of({{name, "text", "0", help}});
  for (const Column& column : columns())
    text += line_of({{column.name, column.type, column.machine ? "1" : "0", column.help}});
  return text;
}

int collect(const CollectOptions& options) {
  if (options.directories.empty()) throw std::invalid_argument("DIR: an output directory is required");
  const fs::path out = options.out;
  for (const fs::path& path : {out, beside(out, "cells"), beside(out, "columns")})
    check_out_file(path, options.force);
  const std::vector<MeasuredCell> cells = find_measured_cells(options.directories);
  std::string text;
  for (const auto& entry : kBefore) text += std::string(entry[0]) + ",";
  text += csv_header();
  std::map<std::string, long> rows;
  long all = 0, incomplete = 0;
  for (const MeasuredCell& cell : cells) {
    const std::string prefix = csv_cell(cell.name) + "," + csv_cell(cell.manifest.cpu_model) + ",";
    const auto add = [&](const MeasuredRow& row) { text += prefix + row.line + "\n", ++rows[cell.name]; };
    const bool whole = visit_rows(cell, add);
    incomplete += !whole || cell.manifest.state != "complete";
    all += rows[cell.name];
  }
  const std::string table = table_of_cells(cells, rows), of_columns = table_of_columns();
  write_whole_files(std::vector<NamedBytes>{
      {beside(out, "columns"), of_columns}, {beside(out, "cells"), table}, {out, text}});
  say(options.out + ": " + std::to_string(all) + " rows of " + std::to_string(cells.size()) +
      " output directories" +
      (incomplete > 0 ? ", " + std::to_string(incomplete) + " of them incomplete" : ""));
  return kExitOk;
}

}  // namespace

std::function<int()> declare_collect(CLI::App& app, const std::vector<std::string>&) {
  const auto options = std::make_shared<CollectOptions>();
  app.add_option("directories", options->directories, "output directories, or directories that hold such")
      ->type_name("DIR ...");
  app.add_option("--out", options->out, "table to write; those of cells and columns lie beside it")
      ->type_name("PATH");
  app.add_flag("--force", options->force, "overwrite the tables");
  return [options] { return collect(*options); };
}

}  // namespace cleave
