// The index of a campaign: a row a cell, whatever became of it. Columns are appended at the end; a table of other columns is of
// another version.
//
// Where it lies: DIR/index.csv for a campaign that one process runs, DIR/shards/IofN/index.csv for a share of it. Beside each lie
// the spec as it was read (spec.toml) and the checksums of both.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/base/column.h"

namespace cleave {

inline constexpr const char* kIndexFile = "index.csv";
inline constexpr const char* kSpecFile = "spec.toml";
inline constexpr const char* kCellsFolder = "cells";
inline constexpr const char* kFailedFolder = "failed";
inline constexpr const char* kShardsFolder = "shards";
inline constexpr const char* kPending =
    "pending";  // status of a cell that has not been run, or not to its end

struct IndexRow {
  std::string cell;  // the name of its directory in cells/
  int number = 0;    // place in the spec, from 1; 0: of an earlier spec
  std::string run_id;
  int round = 1;
  std::string status = kPending;
  std::string reason = "-";
  int rows = 0, rows_ok = 0;
  double run_s = 0, process_s = 0;
  std::string machine = "-", git_hash = "-", build = "-", utc_start = "-";
  std::string checksums = "-", log = "-";
  std::string arguments;

  bool is_pending() const { return status == kPending; }
};

// The one list of columns, in order: visit(name, member, help).
template <class Row, class Visit>
void visit_index(Row& row, Visit&& visit) {
  visit("cell", row.cell, "name of the cell: its directory in cells/, its log in failed/");
  visit("number", row.number, "place in the spec, from 1; 0 where the spec as it is now has no such cell");
  visit("run_id", row.run_id, "fingerprint of all options but those that change no row");
  visit("round", row.round, "which of the rounds");
  visit("status", row.status,
        "pending, ok, the status of its first row that is not ok, or how its process ended");
  visit("reason", row.reason, "why it is not ok");
  visit("rows", row.rows, "rows of its steps.csv");
  visit("rows_ok", row.rows_ok, "those with status ok");
  visit("run_s", row.run_s, "s, that the run itself counts");
  visit("process_s", row.process_s,
        "s, from start to end of its process; nan where the campaign was killed before it wrote that down");
  visit("machine", row.machine, "processor it ran on");
  visit("git_hash", row.git_hash, "commit of the program");
  visit("build", row.build, "fingerprint of commit, flags and build type, of local changes too");
  visit("utc_start", row.utc_start, "when it began");
  visit("checksums", row.checksums, "SHA-256 of the file checksums in its directory; - where there is none");
  visit("log", row.log, "SHA-256 of its log in failed/; - where there is none");
  visit("arguments", row.arguments, "of cleave run");
}

std::vector<Column> index_columns();

// Header and rows.
std::string index_text(const std::vector<IndexRow>& rows);

// Throws std::invalid_argument naming the file and what is wrong: it cannot be read, its columns are others, a line that no
// program wrote.
std::vector<IndexRow> read_index(const std::filesystem::path& path);

// The same errors of its first line alone.
void check_index_columns(const std::filesystem::path& path);

// Where the index of share shard of shards lies; `out` itself for 1 of 1.
std::filesystem::path share_directory(const std::filesystem::path& out, int shard, int shards);

// All directories of a campaign that hold an index: `out` first.
std::vector<std::filesystem::path> share_directories(const std::filesystem::path& out);

// Writes index, then checksums of index and spec, each whole.
void write_index(const std::filesystem::path& share, const std::vector<IndexRow>& rows);

}  // namespace cleave
