// The index of a campaign: a row a cell, whatever became of it. Columns are appended at the end; a table of
// other columns is of another version.
//
// Where it lies: DIR/index.csv for a campaign that one process runs, DIR/shards/IofN/index.csv for a share of
// it. Beside each lie the spec as it was read (spec.toml) and the checksums of both.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cleave {

inline constexpr const char* kIndexFile = "index.csv";
inline constexpr const char* kSpecFile = "spec.toml";
inline constexpr const char* kCellsFolder = "cells";
inline constexpr const char* kFailedFolder = "failed";
inline constexpr const char* kShardsFolder = "shards";
inline constexpr const char* kSlurmFolder = "slurm";  // what scripts/slurm/submit keeps there: no result
inline constexpr const char* kMergedTable = "results.csv";  // in DIR or in that folder, of cleave collect
inline constexpr const char* kPending =
    "pending";  // status of a cell that has not been run, or not to its end

struct IndexRow {
  std::string cell;    // name of the cell: its directory in cells/, its log in failed/
  int number = 0;      // place in the spec, from 1; 0 where the spec as it is now has no such cell
  std::string run_id;  // fingerprint of all options but those that change no row
  int round = 1;       // which of the rounds
  std::string status =
      kPending;  // pending, ok, the status of its first row that is not ok, or how its process ended
  std::string reason = "-";  // why it is not ok
  int rows = 0;              // rows of its steps.csv
  int rows_ok = 0;           // those with status ok
  double run_s = 0;          // s, that the run itself counts
  double process_s =
      0;  // s, from start to end of its process; nan where the campaign was killed before it wrote that down
  std::string machine = "-";    // processor it ran on
  std::string git_hash = "-";   // commit of the program
  std::string build = "-";      // fingerprint of commit, flags and build type, of local changes too
  std::string utc_start = "-";  // when it began
  std::string checksums = "-";  // SHA-256 of the file checksums in its directory; - where there is none
  std::string log = "-";        // SHA-256 of its log in failed/; - where there is none
  std::string arguments;        // of cleave run
  std::string label = "-";      // what the spec calls the cell; - where it has no label

  bool is_pending() const { return status == kPending; }
  const std::string& title() const { return label == "-" ? cell : label; }
};

// The one list of columns, in order: visit(name, member).
template <class Row, class Visit>
void visit_index(Row&& row, Visit&& visit) {
  visit("cell", row.cell);
  visit("number", row.number);
  visit("run_id", row.run_id);
  visit("round", row.round);
  visit("status", row.status);
  visit("reason", row.reason);
  visit("rows", row.rows);
  visit("rows_ok", row.rows_ok);
  visit("run_s", row.run_s);
  visit("process_s", row.process_s);
  visit("machine", row.machine);
  visit("git_hash", row.git_hash);
  visit("build", row.build);
  visit("utc_start", row.utc_start);
  visit("checksums", row.checksums);
  visit("log", row.log);
  visit("arguments", row.arguments);
  visit("label", row.label);
}

// Header and rows.
std::string index_text(const std::vector<IndexRow>& rows);

// Throws std::invalid_argument naming the file and what is wrong: it cannot be read, its columns are others,
// a line that no program wrote.
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
