// The files of `cleave collect`: results.csv has a row per measured cell and step; results.cells.csv a row
// per output directory, joined by `cell`; results.columns.csv says what each column is; results.checksums has
// the SHA-256 of the three.
#pragma once

#include <array>
#include <filesystem>

#include "harness/commands/check_list.h"

namespace cleave {

struct CollectedTables {
  explicit CollectedTables(const std::filesystem::path& out);

  std::filesystem::path rows, cells, columns, checksums;
  std::array<std::filesystem::path, 3> tables() const { return {columns, cells, rows}; }
};

// Whether the three are there, byte for byte as they were written.
void check_collected_tables(const std::filesystem::path& out, CheckList& list);

}  // namespace cleave
